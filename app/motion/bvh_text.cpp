// BVH grammar as used in the wild (Biovision's own files, the CMU conversions, motion editors' exports):
//   HIERARCHY, ROOT name { OFFSET x y z, CHANNELS n names..., JOINT name {...}, End Site { OFFSET x y z } },
//   MOTION, Frames: n, Frame Time: t, then one line of numbers a frame. Keywords in any case, braces on any line.
#include "app/motion/bvh_text.h"

#include <array>

#include "app/files/text_scanner.h"

namespace app {

namespace {

// A body has below 200 joints with all its fingers; the limit keeps hostile files cheap.
constexpr int kMaxJoints = 4096;
constexpr int kMaxFrames = 10'000'000;
constexpr double kLargestLength = 1e7;                        // file's units
constexpr double kLargestAngle = 1e6;                         // degrees: unwrapped spins may count many turns
constexpr double kShortestFrame = 1e-5, kLongestFrame = 100;  // s

bool readChannelName(std::string_view word, BvhChannel& channel) {
  constexpr std::array<std::string_view, 6> kNames = {"Xposition", "Yposition", "Zposition",
                                                      "Xrotation", "Yrotation", "Zrotation"};
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (!sameWord(word, kNames[i])) continue;
    channel = static_cast<BvhChannel>(i);
    return true;
  }
  return false;
}

void expect(TextScanner& scanner, std::string_view wanted) {
  const std::string_view found = scanner.word();
  if (found.empty()) {
    scanner.fail("the text ends where '" + std::string(wanted) + "' should stand", "complete the file");
  }
  if (!sameWord(found, wanted)) {
    scanner.fail("found " + app::quoted(found) + " where '" + std::string(wanted) + "' should stand",
                 "check that the file is a complete BVH file");
  }
}

// `Frames:` and `Frame Time:` are written with and without a blank before the colon, or without one after it.
void expectColon(TextScanner& scanner) {
  if (scanner.skipBlanks() && scanner.text[scanner.at] == ':') ++scanner.at;
}

Eigen::Vector3d readOffset(TextScanner& scanner) {
  Eigen::Vector3d offset;
  for (double& value : offset) value = scanner.number("OFFSET", kLargestLength);
  return offset;
}

void readChannels(TextScanner& scanner, BvhText& bvh, BvhTextJoint& joint) {
  if (!joint.channels.empty()) scanner.fail("a second CHANNELS in one joint", "keep one");
  const long long count = scanner.count("the number of CHANNELS", 6);
  joint.first_channel = bvh.channel_count;
  for (long long i = 0; i < count; ++i) {
    const std::string_view word = scanner.word();
    BvhChannel channel;
    if (!readChannelName(word, channel)) {
      scanner.fail(word.empty() ? "the text ends inside CHANNELS" : app::quoted(word) + " is not a channel",
                   "use Xposition, Yposition, Zposition, Xrotation, Yrotation, Zrotation, as many as CHANNELS says");
    }
    joint.channels.push_back(channel);
  }
  bvh.channel_count += static_cast<int>(count);
}

void readEndSite(TextScanner& scanner, BvhTextJoint& joint) {
  scanner.lineUpToBrace();  // 'Site', or whatever name an exporter gave it
  expect(scanner, "{");
  expect(scanner, "OFFSET");
  const Eigen::Vector3d offset = readOffset(scanner);
  expect(scanner, "}");
  if (!joint.has_end_site) joint.end_site = offset;
  joint.has_end_site = true;
}

int openJoint(TextScanner& scanner, BvhText& bvh, int parent) {
  if (bvh.joints.size() >= kMaxJoints) {
    scanner.fail("more than " + std::to_string(kMaxJoints) + " joints", "leave out what is not a body's skeleton");
  }
  BvhTextJoint joint;
  joint.name = scanner.lineUpToBrace();
  if (joint.name.empty()) joint.name = "joint_" + std::to_string(bvh.joints.size());
  joint.parent = parent;
  bvh.joints.push_back(std::move(joint));
  expect(scanner, "{");
  return static_cast<int>(bvh.joints.size()) - 1;
}

// Iterative: a file of thousands of nested joints must not use up the call stack.
void readHierarchy(TextScanner& scanner, BvhText& bvh) {
  if (scanner.text.starts_with("\xEF\xBB\xBF")) scanner.at = 3;  // byte order mark
  expect(scanner, "HIERARCHY");
  bvh.hierarchy_line = scanner.line;
  expect(scanner, "ROOT");
  int current = openJoint(scanner, bvh, -1);
  while (current >= 0) {
    BvhTextJoint& joint = bvh.joints[static_cast<std::size_t>(current)];
    const std::string_view word = scanner.word();
    if (sameWord(word, "OFFSET")) {
      joint.offset = readOffset(scanner);
    } else if (sameWord(word, "CHANNELS")) {
      readChannels(scanner, bvh, joint);
    } else if (sameWord(word, "End")) {
      readEndSite(scanner, joint);
    } else if (sameWord(word, "JOINT")) {
      current = openJoint(scanner, bvh, current);
    } else if (word == "}") {
      current = joint.parent;
    } else if (word.empty()) {
      scanner.fail("the text ends inside joint " + app::quoted(joint.name), "close every brace and add the motion");
    } else {
      scanner.fail("found " + app::quoted(word) + " inside joint " + app::quoted(joint.name),
                   "expected OFFSET, CHANNELS, JOINT, End Site or a closing brace");
    }
  }
  const std::string_view next = scanner.word();
  if (sameWord(next, "ROOT")) scanner.fail("a second ROOT", "keep one figure a file");
  if (next == "}") scanner.fail("a closing brace too many", "match the braces");
  if (next.empty()) scanner.fail("the text ends before MOTION", "complete the file");
  if (!sameWord(next, "MOTION"))
    scanner.fail("found " + app::quoted(next) + " where MOTION should stand", "match the braces");
}

void readMotionHead(TextScanner& scanner, BvhText& bvh) {
  if (bvh.channel_count == 0) scanner.fail("no joint has CHANNELS, so nothing can move", "give the joints channels");
  std::string_view word = scanner.word();
  if (word.size() > 6 && word[6] == ':') {  // 'Frames:30' without a blank
    scanner.at -= word.size() - 6;
    word = word.substr(0, 6);
  }
  if (!sameWord(word, "Frames")) scanner.fail("'Frames:' should stand after MOTION", "add the number of frames");
  expectColon(scanner);
  const long long frames = scanner.count("the number of Frames", kMaxFrames);
  if (frames < 1) scanner.fail("the clip has no frames", "give a clip with at least one");
  // Checked before anything is allocated: a number and its separator take two characters.
  const auto most_values = static_cast<long long>(scanner.left() / 2 + 1);
  if (frames > most_values / bvh.channel_count + 1) {
    scanner.fail("says " + std::to_string(frames) + " frames, more than the rest of the text can hold",
                 "correct the number of frames or complete the file");
  }
  // Joints without channels cost no text, but memory in every frame.
  constexpr long long kMaxBytesPerCharacter = 64, kBytesPerJoint = 56;
  if (frames * static_cast<long long>(bvh.joints.size()) * kBytesPerJoint >
      kMaxBytesPerCharacter * static_cast<long long>(scanner.text.size()) + (1 << 20)) {
    scanner.fail("too many frames of too many joints without channels", "remove joints that do not move");
  }
  bvh.frame_count = static_cast<int>(frames);

  expect(scanner, "Frame");
  word = scanner.word();
  if (word.size() > 4 && word[4] == ':') {
    scanner.at -= word.size() - 4;
    word = word.substr(0, 4);
  }
  if (!sameWord(word, "Time")) scanner.fail("'Frame Time:' should stand after 'Frames:'", "add the frame time");
  expectColon(scanner);
  bvh.frame_time = scanner.number("the Frame Time", 1e9);
  if (bvh.frame_time < kShortestFrame || bvh.frame_time > kLongestFrame) {
    scanner.fail("the Frame Time is not between 0.00001 and 100 s", "write the seconds a frame, such as 0.0333333");
  }
}

void readRow(TextScanner& scanner, BvhText& bvh, int frame) {
  const std::string channels = std::to_string(bvh.channel_count);
  const std::size_t row_begin = bvh.values.size();
  for (const BvhTextJoint& joint : bvh.joints) {
    for (const BvhChannel channel : joint.channels) {
      if (!scanner.skipBlanksInLine()) {
        const std::size_t found = bvh.values.size() - row_begin;
        scanner.fail(
            "frame " + std::to_string(frame) + " has " + std::to_string(found) + " of " + channels + " numbers",
            "give every frame one line with a number for each channel");
      }
      bvh.values.push_back(isPosition(channel) ? scanner.number("a position", kLargestLength)
                                               : scanner.number("an angle", kLargestAngle));
    }
  }
  if (scanner.skipBlanksInLine()) {
    scanner.fail("frame " + std::to_string(frame) + " has more than " + channels + " numbers",
                 "give every frame one line with a number for each channel");
  }
}

void readRows(TextScanner& scanner, BvhText& bvh) {
  const std::string declared = std::to_string(bvh.frame_count);
  const std::size_t value_count =
      static_cast<std::size_t>(bvh.frame_count) * static_cast<std::size_t>(bvh.channel_count);
  bvh.values.reserve(value_count);
  for (int frame = 0; frame < bvh.frame_count; ++frame) {
    if (!scanner.skipBlanks()) {
      scanner.fail("the motion ends after " + std::to_string(frame) + " of " + declared + " frames",
                   "correct 'Frames:' or complete the file");
    }
    readRow(scanner, bvh, frame);
  }
  // Some exporters count frames from 0 and declare one less than they write (assimp's Boxing_Toes.bvh): one more
  // complete row is read and left out, anything else means that the count or the file is wrong.
  if (!scanner.skipBlanks()) return;
  readRow(scanner, bvh, bvh.frame_count);
  bvh.values.resize(value_count);
  bvh.has_surplus_row = true;
  if (scanner.skipBlanks()) scanner.fail("more rows than the " + declared + " declared frames", "correct 'Frames:'");
}

}  // namespace

BvhText readBvhText(std::string_view text, const std::string& file) {
  TextScanner scanner{text, file};
  BvhText bvh;
  readHierarchy(scanner, bvh);
  readMotionHead(scanner, bvh);
  readRows(scanner, bvh);
  return bvh;
}

}  // namespace app
