// ARCSim's rigid body motion: 'NumFrames: N', then for each body b the blocks 'body[b] position' with N lines 'x y z'
// and 'body[b] orientation' with N lines 'w x y z', metres, z up (format: shared/arcsim/README.txt).
#include <charconv>
#include <numbers>

#include "app/files/text_scanner.h"
#include "app/motion/motion.h"

namespace app {

namespace {

constexpr int kMaxBodies = 4096;
constexpr int kMaxMotFrames = 10'000'000;

struct BodyText {
  std::vector<Vec3> positions;
  std::vector<Eigen::Quaterniond> orientations;
};

int readFrameCount(TextScanner& scanner) {
  std::string_view word = scanner.word();
  if (word.size() > 10 && word[9] == ':') {  // 'NumFrames:30' without a blank
    scanner.at -= word.size() - 10;
    word = word.substr(0, 10);
  }
  if (!sameWord(word, "NumFrames:")) {
    scanner.fail("'NumFrames:' should open the file", "give an ARCSim .mot file");
  }
  const long long frames = scanner.count("NumFrames", kMaxMotFrames);
  if (frames < 2) scanner.fail("the motion has fewer than two frames", "give a motion with at least two frames");
  // A body's frame takes at least 'x y z' and 'w x y z', 14 characters with their separators: checked before
  // allocation.
  if (static_cast<unsigned long long>(frames) > scanner.left() / 14 + 1) {
    scanner.fail("says " + std::to_string(frames) + " frames, more than the rest of the text can hold",
                 "correct NumFrames or complete the file");
  }
  return static_cast<int>(frames);
}

// 'body[12]' to 12.
int readBodyIndex(TextScanner& scanner) {
  const std::string_view word = scanner.word();
  int index = -1;
  bool good = word.size() > 6 && sameWord(word.substr(0, 5), "body[") && word.back() == ']';
  if (good) {
    const char* last = word.data() + word.size() - 1;
    const auto [end, error] = std::from_chars(word.data() + 5, last, index);
    good = error == std::errc() && end == last && index >= 0;
  }
  if (!good) scanner.fail("found " + quoted(word) + " where 'body[b] position' should stand", "check NumFrames");
  if (index >= kMaxBodies)
    scanner.fail("a body number above " + std::to_string(kMaxBodies - 1), "number bodies from 0");
  return index;
}

void readRow(TextScanner& scanner, std::span<double> row, const char* what) {
  if (!scanner.skipBlanks()) {
    scanner.fail(std::string("the text ends inside a block of ") + what + "s",
                 "complete the file or correct NumFrames");
  }
  for (double& value : row) {
    if (!scanner.skipBlanksInLine()) {
      scanner.fail("fewer than " + std::to_string(row.size()) + " numbers in a line",
                   std::string("complete the ") + what);
    }
    value = scanner.number(what, 1e6);
  }
  if (scanner.skipBlanksInLine()) {
    scanner.fail("more than " + std::to_string(row.size()) + " numbers in a line", std::string("correct the ") + what);
  }
}

void readPositions(TextScanner& scanner, int frames, BodyText& body) {
  if (!body.positions.empty()) scanner.fail("a second block of positions for one body", "remove it");
  body.positions.reserve(static_cast<std::size_t>(frames));
  for (int f = 0; f < frames; ++f) {
    Vec3 p;
    readRow(scanner, {p.data(), 3}, "position");
    body.positions.emplace_back(p.x(), p.z(), -p.y());
  }
}

void readOrientations(TextScanner& scanner, int frames, BodyText& body) {
  if (!body.orientations.empty()) scanner.fail("a second block of orientations for one body", "remove it");
  const Eigen::Quaterniond y_up(Eigen::AngleAxisd(-std::numbers::pi / 2, Vec3::UnitX()));
  body.orientations.reserve(static_cast<std::size_t>(frames));
  for (int f = 0; f < frames; ++f) {
    double wxyz[4];
    readRow(scanner, wxyz, "orientation");
    Eigen::Quaterniond q(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
    if (q.norm() < 1e-6) scanner.fail("an orientation of length zero", "write a unit quaternion 'w x y z'");
    q = y_up * q.normalized();
    // q and -q are one rotation: the nearer to the frame before keeps interpolation short.
    if (f > 0 && q.dot(body.orientations.back()) < 0) q.coeffs() = -q.coeffs();
    body.orientations.push_back(q);
  }
}

}  // namespace

RigidMotion readMot(std::string_view text, const std::string& file) {
  TextScanner scanner{text, file};
  const int frames = readFrameCount(scanner);
  std::vector<BodyText> bodies;
  while (scanner.skipBlanks()) {
    const auto index = static_cast<std::size_t>(readBodyIndex(scanner));
    if (index >= bodies.size()) bodies.resize(index + 1);
    const std::string_view block = scanner.word();
    if (sameWord(block, "position")) {
      readPositions(scanner, frames, bodies[index]);
    } else if (sameWord(block, "orientation")) {
      readOrientations(scanner, frames, bodies[index]);
    } else {
      scanner.fail("found " + quoted(block) + " after the body", "write 'position' or 'orientation'");
    }
  }
  if (bodies.empty())
    scanner.fail("the motion has no bodies", "give at least 'body[0] position' and 'body[0] orientation'");
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (!bodies[b].positions.empty() && !bodies[b].orientations.empty()) continue;
    scanner.fail(
        "body " + std::to_string(b) + " has no " + (bodies[b].positions.empty() ? "positions" : "orientations"),
        "number bodies from 0 and give each both blocks");
  }

  RigidMotion motion;
  motion.body_count = static_cast<int>(bodies.size());
  motion.frame_count = frames;
  motion.bodies.resize(bodies.size() * static_cast<std::size_t>(frames));
  for (std::size_t f = 0; f < static_cast<std::size_t>(frames); ++f) {
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      Rigid& rigid = motion.bodies[f * bodies.size() + b];
      rigid = Rigid(bodies[b].orientations[f]);
      rigid.translation() = bodies[b].positions[f];
    }
  }
  return motion;
}

}  // namespace app
