#include "sim/linear/compact_factor.h"

#include <algorithm>
#include <cmath>

#include "sim/linear/lanes.h"

namespace sim {
namespace {

constexpr int kRows = 16;       // rows of a strip
constexpr int kColumns = 4;     // columns whose sums a transposed product keeps in registers; even
constexpr float kUnit = 65536;  // of an entry, as the integers below show it
constexpr float kMost = 32766;  // largest entry; one less than fits, for the carry of its neighbour

// Sixteen rows at once: one register of the widest processors, two or four of the others.
typedef float Row16 __attribute__((vector_size(kRows * sizeof(float))));
typedef std::int32_t Pair16 __attribute__((vector_size(kRows * sizeof(std::int32_t))));

int stripsOf(int rows) {
  return (rows + kRows - 1) / kRows;
}
HAIRMESH_INLINE int evenOf(int columns) {
  return columns + columns % 2;
}

// Columns of a strip, even: a triangle's strip s ends at the diagonal.
HAIRMESH_INLINE int stripWidth(int w, int s, bool triangle) {
  const int even = evenOf(w);
  return triangle && kRows * (s + 1) < even ? kRows * (s + 1) : even;
}

// Two columns share a word, the first times kUnit plus the second. Taken whole, the word is the first column to within
// half an entry's unit, which its rounding has already made up for; shifted up, it is the second.
HAIRMESH_INLINE Pair16 loadPair(const std::int32_t* q) {
  Pair16 pair;
  __builtin_memcpy(&pair, q, sizeof pair);
  return pair;
}
HAIRMESH_INLINE Row16 firstOf(const Pair16& pair) {
  return __builtin_convertvector(pair, Row16);
}
HAIRMESH_INLINE Row16 secondOf(const Pair16& pair) {
  return __builtin_convertvector(pair << 16, Row16);
}

// y = Q x, x already times the columns' scales; y has kRows entries a strip.
HAIRMESH_CLONES void multiplyStrips(const std::int32_t* q, int strips, int w, bool triangle, const float* x, float* y) {
  for (int s = 0; s < strips; ++s) {
    const int width = stripWidth(w, s, triangle);
    Row16 a{}, b{}, c{}, d{};
    int j = 0;
    for (; j + 4 <= width; j += 4, q += 2 * kRows) {
      const Pair16 one = loadPair(q), two = loadPair(q + kRows);
      a += firstOf(one) * x[j];
      b += secondOf(one) * x[j + 1];
      c += firstOf(two) * x[j + 2];
      d += secondOf(two) * x[j + 3];
    }
    if (j < width) {
      const Pair16 one = loadPair(q);
      a += firstOf(one) * x[j];
      b += secondOf(one) * x[j + 1];
      q += kRows;
    }
    const Row16 sum = (a + b) + (c + d);
    __builtin_memcpy(y + kRows * s, &sum, sizeof sum);
  }
}

HAIRMESH_INLINE float sumOf(const Row16& v) {
  Lanes<float> low, high;
  __builtin_memcpy(&low, &v, sizeof low);
  __builtin_memcpy(&high, reinterpret_cast<const float*>(&v) + kLanes, sizeof high);
  low += high;
  return ((low[0] + low[4]) + (low[2] + low[6])) + ((low[1] + low[5]) + (low[3] + low[7]));
}

// out[j] = (Q^T y)_j, not yet times the columns' scales.
HAIRMESH_CLONES void multiplyStripsTransposed(const std::int32_t* q, int strips, int w, bool triangle, const float* y,
                                              float* out) {
  const int even = evenOf(w);
  for (int first = 0; first < even; first += kColumns) {
    const int begin = triangle ? first / kRows : 0;
    // Strips before `begin` of a triangle hold kRows, 2 kRows, ... columns.
    const std::int32_t* strip = q + (triangle ? std::size_t(kRows) * kRows / 2 * begin * (begin + 1) / 2 : 0);
    Row16 a{}, b{}, c{}, d{};
    const bool both = first + kColumns <= even;
    for (int s = begin; s < strips; ++s) {
      Row16 ys;
      __builtin_memcpy(&ys, y + kRows * s, sizeof ys);
      const std::int32_t* at = strip + std::size_t(kRows) * (first / 2);
      const Pair16 one = loadPair(at);
      a += firstOf(one) * ys;
      b += secondOf(one) * ys;
      if (both) {
        const Pair16 two = loadPair(at + kRows);
        c += firstOf(two) * ys;
        d += secondOf(two) * ys;
      }
      strip += std::size_t(kRows) * (stripWidth(w, s, triangle) / 2);
    }
    out[first] = sumOf(a), out[first + 1] = sumOf(b);
    if (both) out[first + 2] = sumOf(c), out[first + 3] = sumOf(d);
  }
}

// Appends a column-major matrix (rows x w) as strips. Scales are those of the whole words.
void appendStrips(const float* from, int rows, int w, bool triangle, std::vector<std::int32_t>& values,
                  std::vector<float>& scales) {
  const std::size_t first_scale = scales.size();
  for (int j = 0; j < evenOf(w); ++j) {
    float most = 0;
    for (int i = 0; j < w && i < rows; ++i) most = std::max(most, std::abs(from[std::size_t(j) * rows + i]));
    scales.push_back(most > 0 ? most / (kMost * kUnit) : 1);
  }
  const auto entry = [&](int i, int j) {
    return i < rows && j < w ? from[std::size_t(j) * rows + i] / (scales[first_scale + j] * kUnit) : 0.0f;
  };
  for (int s = 0; s < stripsOf(rows); ++s) {
    for (int j = 0; j < stripWidth(w, s, triangle); j += 2) {
      for (int i = kRows * s; i < kRows * (s + 1); ++i) {
        const long second = std::lround(std::clamp(entry(i, j + 1), -kMost, kMost));
        const long first = std::lround(std::clamp(entry(i, j) - static_cast<float>(second) / kUnit, -kMost, kMost));
        values.push_back(static_cast<std::int32_t>(first * 65536 + second));
      }
    }
  }
}

// The padding of the last strip meets zeros of Q, but what an earlier panel left there need not be finite.
void clearPadding(std::vector<float>& x, int rows) {
  for (int i = rows; i < kRows * stripsOf(rows); ++i) x[i] = 0;
}

// The columns are padded to an even number.
void takeScaled(const float* x, const float* scale, int w, float* out) {
  for (int j = 0; j < w; ++j) out[j] = x[j] * scale[j];
  if (w % 2) out[w] = 0;
}

}  // namespace

void CompactFactor::begin(const BlockCholesky<float>& factor) {
  values_.clear(), scales_.clear(), triangle_at_.clear(), rows_at_.clear(), scales_at_.clear();
  values_.reserve(factor.values.size() * 3 / 4);
  int widest = 0, highest = 0;
  for (const auto& s : factor.supernodes) {
    widest = std::max(widest, s.width());
    highest = std::max(highest, s.height());
  }
  x_.resize(3 * factor.order.size());
  gathered_.assign(kRows * stripsOf(std::max(highest, widest)), 0);
  scaled_.assign(kRows * stripsOf(widest), 0);
}

void CompactFactor::append(const BlockCholesky<float>& factor, int end) {
  for (int k = static_cast<int>(rows_at_.size()); k < end; ++k) {
    const auto& s = factor.supernodes[k];
    const int w = s.width(), h = s.height();
    const float* inverse = factor.values.data() + s.values;
    scales_at_.push_back(scales_.size());
    triangle_at_.push_back(values_.size());
    appendStrips(inverse, w, w, true, values_, scales_);
    rows_at_.push_back(values_.size());
    appendStrips(inverse + static_cast<std::size_t>(w) * w, h, w, false, values_, scales_);
  }
}

void CompactFactor::assign(const BlockCholesky<float>& factor) {
  begin(factor);
  append(factor, static_cast<int>(factor.supernodes.size()));
}

void CompactFactor::solve(const BlockCholesky<float>& factor, std::span<const V3<float>> r, std::span<V3<float>> z) {
  float* x = x_.data();
  for (std::size_t k = 0; k < factor.order.size(); ++k) {
    const V3<float>& b = r[factor.order[k]];
    x[3 * k] = b.x, x[3 * k + 1] = b.y, x[3 * k + 2] = b.z;
  }
  const int count = static_cast<int>(factor.supernodes.size());
  for (int k = 0; k < count; ++k) {
    const auto& s = factor.supernodes[k];
    const int w = s.width(), h = s.height();
    const float* scale = scales_.data() + scales_at_[k];
    float* own = x + 3 * s.first;
    takeScaled(own, scale, w, scaled_.data());
    multiplyStrips(values_.data() + triangle_at_[k], stripsOf(w), w, true, scaled_.data(), gathered_.data());
    std::copy_n(gathered_.data(), w, own);
    if (h == 0) continue;
    takeScaled(own, scale + evenOf(w), w, scaled_.data());
    multiplyStrips(values_.data() + rows_at_[k], stripsOf(h), w, false, scaled_.data(), gathered_.data());
    for (int i = 0; i < s.rows; ++i) {
      float* y = x + 3 * factor.row_index[s.rows_first + i];
      y[0] -= gathered_[3 * i], y[1] -= gathered_[3 * i + 1], y[2] -= gathered_[3 * i + 2];
    }
  }
  for (int k = count - 1; k >= 0; --k) {
    const auto& s = factor.supernodes[k];
    const int w = s.width(), h = s.height();
    const float* scale = scales_.data() + scales_at_[k];
    float* own = x + 3 * s.first;
    if (h > 0) {
      for (int i = 0; i < s.rows; ++i) {
        const float* y = x + 3 * factor.row_index[s.rows_first + i];
        gathered_[3 * i] = y[0], gathered_[3 * i + 1] = y[1], gathered_[3 * i + 2] = y[2];
      }
      clearPadding(gathered_, h);
      multiplyStripsTransposed(values_.data() + rows_at_[k], stripsOf(h), w, false, gathered_.data(), scaled_.data());
      for (int j = 0; j < w; ++j) own[j] -= scaled_[j] * scale[evenOf(w) + j];
    }
    std::copy_n(own, w, gathered_.data());
    clearPadding(gathered_, w);
    multiplyStripsTransposed(values_.data() + triangle_at_[k], stripsOf(w), w, true, gathered_.data(), scaled_.data());
    for (int j = 0; j < w; ++j) own[j] = scaled_[j] * scale[j];
  }
  for (std::size_t i = 0; i < factor.position.size(); ++i) {
    const int k = factor.position[i];
    z[i] = k < 0 ? V3<float>{0, 0, 0} : V3<float>{x[3 * k], x[3 * k + 1], x[3 * k + 2]};
  }
}

}  // namespace sim
