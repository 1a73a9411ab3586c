// s: a supernode, L_ss: its triangle, L_rs: its rows below; w: its width, h: its height, both in scalars.
#include "sim/linear/block_cholesky.h"

#include <algorithm>
#include <cmath>

#include "sim/linear/dense_kernels.h"
#include "sim/linear/elimination_order.h"

namespace sim {
namespace {

// Column structures below the diagonal (elimination positions, ascending) and the elimination tree, by merging
// children.
void eliminate(const BlockPattern& pattern, const std::vector<int>& order, const std::vector<int>& position,
               std::vector<std::vector<int>>& below, std::vector<int>& parent) {
  const int n = static_cast<int>(order.size());
  below.assign(n, {});
  parent.assign(n, -1);
  for (int i = 0; i < pattern.size; ++i) {
    for (int k = pattern.row_first[i]; k < pattern.row_first[i + 1]; ++k) {
      const int p = position[i], q = position[pattern.columns[k]];
      if (p >= 0 && q >= 0) below[std::min(p, q)].push_back(std::max(p, q));
    }
  }
  std::vector<std::vector<int>> children(n);
  std::vector<int> mark(n, -1);
  for (int c = 0; c < n; ++c) {
    std::vector<int> merged;
    mark[c] = c;
    const auto take = [&](const std::vector<int>& rows) {
      for (int r : rows) {
        if (mark[r] != c) mark[r] = c, merged.push_back(r);
      }
    };
    take(below[c]);
    for (int child : children[c]) take(below[child]);
    std::sort(merged.begin(), merged.end());
    below[c] = std::move(merged);
    if (!below[c].empty()) {
      parent[c] = below[c].front();
      children[parent[c]].push_back(c);
    }
  }
}

// Renumbers the columns in postorder of the elimination tree, so that the columns of a supernode are neighbours.
void postorder(std::vector<int>& order, std::vector<int>& position, const std::vector<int>& parent) {
  const int n = static_cast<int>(order.size());
  std::vector<std::vector<int>> children(n + 1);
  for (int c = 0; c < n; ++c) children[parent[c] < 0 ? n : parent[c]].push_back(c);
  std::vector<int> sequence, stack{n};
  std::vector<std::size_t> visited(n + 1, 0);
  while (!stack.empty()) {
    const int c = stack.back();
    if (visited[c] < children[c].size()) {
      stack.push_back(children[c][visited[c]++]);
    } else {
      if (c < n) sequence.push_back(c);
      stack.pop_back();
    }
  }
  std::vector<int> renumbered(n);
  for (int k = 0; k < n; ++k) renumbered[k] = order[sequence[k]];
  order = std::move(renumbered);
  for (int k = 0; k < n; ++k) position[order[k]] = k;
}

}  // namespace

template <class T>
void BlockCholesky<T>::analyze(const BlockPattern& pattern, std::vector<int> elimination_order) {
  order = std::move(elimination_order);
  const int n = static_cast<int>(order.size());
  position.assign(pattern.size, -1);
  for (int k = 0; k < n; ++k) position[order[k]] = k;
  std::vector<std::vector<int>> below;
  std::vector<int> parent;
  eliminate(pattern, order, position, below, parent);
  postorder(order, position, parent);
  eliminate(pattern, order, position, below, parent);
  findSupernodes(below, parent);
  sizeScratch();
  sortEntries(pattern);
  at_ = {};
}

// A column joins the supernode before it when it is its parent and the zeros that this stores are few.
template <class T>
void BlockCholesky<T>::findSupernodes(const std::vector<std::vector<int>>& below, const std::vector<int>& parent) {
  const int n = static_cast<int>(order.size());
  supernodes.clear();
  row_index.clear();
  supernode_of_.assign(n, -1);
  value_count_ = 0;
  for (int c = 0; c < n;) {
    Supernode s;
    s.first = c;
    s.columns = 1;
    std::size_t true_blocks = below[c].size();
    while (c + s.columns < n && parent[c + s.columns - 1] == c + s.columns) {
      const std::size_t next = below[c + s.columns].size();
      const std::size_t stored =
          static_cast<std::size_t>(s.columns + 1) * next + static_cast<std::size_t>(s.columns + 1) * s.columns / 2;
      if (stored > (true_blocks + next) * 5 / 4 + 12) break;
      true_blocks += next;
      ++s.columns;
    }
    // The union of the structures is the last column's, since each column's parent is the next.
    const std::vector<int>& rows = below[c + s.columns - 1];
    s.rows_first = static_cast<int>(row_index.size());
    s.rows = static_cast<int>(rows.size());
    row_index.insert(row_index.end(), rows.begin(), rows.end());
    s.values = value_count_;
    value_count_ += static_cast<std::size_t>(s.width()) * (s.width() + s.height());
    for (int k = 0; k < s.columns; ++k) supernode_of_[c + k] = static_cast<int>(supernodes.size());
    c += s.columns;
    supernodes.push_back(s);
  }
  for (Supernode& s : supernodes) s.parent = s.rows > 0 ? supernode_of_[row_index[s.rows_first]] : -1;
}

template <class T>
void BlockCholesky<T>::sizeScratch() {
  int tallest = 0;
  largest_front_ = 0;
  std::vector<int> child_count(supernodes.size(), 0);
  for (const Supernode& s : supernodes) {
    largest_front_ = std::max(largest_front_, s.width() + s.height());
    tallest = std::max(tallest, s.height());
    if (s.parent >= 0) ++child_count[s.parent];
  }
  work_.assign(3 * order.size(), T(0));
  gathered_.assign(tallest, T(0));
  local_.assign(order.size(), -1);
  // Deepest the stack of update matrices gets: supernodes are in postorder, so children pop before their parent pushes.
  std::vector<std::size_t> pending;
  std::size_t depth = 0;
  deepest_stack_ = 0;
  for (std::size_t k = 0; k < supernodes.size(); ++k) {
    for (int child = 0; child < child_count[k]; ++child) {
      depth -= pending.back();
      pending.pop_back();
    }
    const Supernode& s = supernodes[k];
    if (s.parent < 0) continue;
    pending.push_back(static_cast<std::size_t>(s.height()) * s.height());
    depth += pending.back();
    deepest_stack_ = std::max(deepest_stack_, depth);
  }
  pending_.reserve(supernodes.size());
}

// Entries of the matrix by the column that eliminates them.
template <class T>
void BlockCholesky<T>::sortEntries(const BlockPattern& pattern) {
  const int n = static_cast<int>(order.size());
  std::vector<std::vector<Entry>> by_column(n);
  for (int i = 0; i < pattern.size; ++i) {
    for (int k = pattern.row_first[i]; k < pattern.row_first[i + 1]; ++k) {
      const int p = position[i], q = position[pattern.columns[k]];
      if (p >= 0 && q >= 0) by_column[std::min(p, q)].push_back({k, std::max(p, q), p < q});
    }
  }
  entries_first_.assign(n + 1, 0);
  entries_.clear();
  for (int c = 0; c < n; ++c) {
    entries_.insert(entries_.end(), by_column[c].begin(), by_column[c].end());
    entries_first_[c + 1] = static_cast<int>(entries_.size());
  }
}

template <class T>
void BlockCholesky<T>::solve(std::span<const V3<T>> r, std::span<V3<T>> z) {
  const int n = static_cast<int>(order.size());
  T* x = work_.data();
  for (int k = 0; k < n; ++k) {
    const V3<T>& b = r[order[k]];
    x[3 * k] = b.x, x[3 * k + 1] = b.y, x[3 * k + 2] = b.z;
  }
  for (const Supernode& s : supernodes) {
    const int w = s.width(), h = s.height();
    const T* inverse = values.data() + s.values;
    const T* rows = inverse + static_cast<std::size_t>(w) * w;
    multiplyLowerInPlace(inverse, w, x + 3 * s.first);
    if (h == 0) continue;
    multiplyPanel(rows, h, w, x + 3 * s.first, gathered_.data());
    for (int k = 0; k < s.rows; ++k) {
      T* y = x + 3 * row_index[s.rows_first + k];
      y[0] -= gathered_[3 * k], y[1] -= gathered_[3 * k + 1], y[2] -= gathered_[3 * k + 2];
    }
  }
  for (auto it = supernodes.rbegin(); it != supernodes.rend(); ++it) {
    const Supernode& s = *it;
    const int w = s.width(), h = s.height();
    const T* inverse = values.data() + s.values;
    const T* rows = inverse + static_cast<std::size_t>(w) * w;
    if (h > 0) {
      for (int k = 0; k < s.rows; ++k) {
        const T* y = x + 3 * row_index[s.rows_first + k];
        gathered_[3 * k] = y[0], gathered_[3 * k + 1] = y[1], gathered_[3 * k + 2] = y[2];
      }
      subtractPanelTransposed(rows, h, w, gathered_.data(), x + 3 * s.first);
    }
    multiplyUpperInPlace(inverse, w, x + 3 * s.first);
  }
  for (std::size_t i = 0; i < position.size(); ++i) {
    const int k = position[i];
    z[i] = k < 0 ? V3<T>{0, 0, 0} : V3<T>{x[3 * k], x[3 * k + 1], x[3 * k + 2]};
  }
}

template struct BlockCholesky<float>;
template struct BlockCholesky<double>;

}  // namespace sim
