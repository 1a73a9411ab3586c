#include "app/scene/record/sim_cache.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string_view>

#include "app/files/errors.h"
#include "app/files/report_line.h"
#include "app/scene/demo.h"
#include "app/scene/demo_state.h"
#include "sim/mesh/field_bytes.h"

namespace app {

namespace {

constexpr std::string_view kCacheTitle = "hairmesh-cache ";
constexpr const char* kWriteAnew = "write it anew with --cache";
constexpr std::size_t kHeadAt = 17;  // bytes of the first line
constexpr std::uint64_t kMaxIdentity = 1 << 20, kEntryBytes = 24;

std::string titleLine() {
  return std::string(kCacheTitle) + std::to_string(kCacheVersion) + "\n";
}

std::string_view charactersOf(const sim::Bytes& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// What moves: the scene's characters with their hair, and the hair meshes' numbers.
std::string identityText(const Demo& demo) {
  std::string text = demoIdentity(demo);
  for (const Actor& actor : demo.actors) {
    sim::Bytes bytes;
    for (const sim::Vec3& p : actor.haircut->mesh.shape.positions) sim::writeBytes(p, bytes);
    text += "; " + std::to_string(actor.haircut->mesh.vertexCount()) + " vertices, " +
            std::to_string(actor.pose.world.size()) + " joints, fingerprint " + std::to_string(sim::fingerprint(bytes));
  }
  return text;
}

void writeVarint(std::int64_t value, sim::Bytes& out) {
  std::uint64_t bits = (static_cast<std::uint64_t>(value) << 1) ^ static_cast<std::uint64_t>(value >> 63);
  do {
    out.push_back(static_cast<std::byte>((bits & 127) | (bits > 127 ? 128 : 0)));
    bits >>= 7;
  } while (bits > 0);
}

std::int64_t readVarint(sim::ByteReader& from) {
  std::uint64_t bits = 0;
  for (unsigned shift = 0; shift < 64; shift += 7) {
    unsigned char byte = 0;
    if (!from.take(&byte, 1)) return 0;
    bits |= static_cast<std::uint64_t>(byte & 127) << shift;
    if (byte < 128) return static_cast<std::int64_t>(bits >> 1) ^ -static_cast<std::int64_t>(bits & 1);
  }
  from.complete = false;
  return 0;
}

void writeShown(const Actor& actor, const Vec3& origin, sim::Bytes& out) {
  for (const Rigid& joint : actor.shown_pose.world) {
    const Eigen::Quaternionf turn(joint.linear().cast<float>());
    const Eigen::Vector3f place = joint.translation().cast<float>();
    for (const float value : {turn.x(), turn.y(), turn.z(), turn.w(), place.x(), place.y(), place.z()})
      sim::writeBytes(value, out);
  }
  std::array<std::int64_t, 3> before{};
  for (std::size_t v = 0; 3 * v + 2 < actor.shown_positions.size(); ++v) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double at = actor.shown_positions[3 * v + k] + origin[static_cast<Eigen::Index>(k)];
      const std::int64_t steps = std::llround(std::clamp(at, -1e9, 1e9) / kCacheStep);
      writeVarint(steps - before[k], out);
      before[k] = steps;
    }
  }
}

struct ShownActor {
  std::vector<Rigid> joints;
  std::vector<sim::Vec3> positions;
};

ShownActor readShown(const Actor& actor, sim::ByteReader& from) {
  ShownActor shown;
  for (std::size_t j = 0; j < actor.pose.world.size() && from.complete; ++j) {
    std::array<float, 7> value{};
    sim::readBytes(from, value);
    Eigen::Quaterniond turn(value[3], value[0], value[1], value[2]);
    const Vec3 place(value[4], value[5], value[6]);
    if (!(turn.norm() > 0.5 && turn.norm() < 2) || !place.allFinite()) from.complete = false;
    Rigid& joint = shown.joints.emplace_back(Rigid::Identity());
    joint.linear() = turn.normalized().toRotationMatrix();
    joint.translation() = place;
  }
  std::array<std::int64_t, 3> steps{};
  for (int v = 0; v < actor.haircut->mesh.vertexCount() && from.complete; ++v) {
    Vec3 p;
    for (std::size_t k = 0; k < 3; ++k) {
      steps[k] = static_cast<std::int64_t>(static_cast<std::uint64_t>(steps[k]) +
                                           static_cast<std::uint64_t>(readVarint(from)));
      p[static_cast<Eigen::Index>(k)] = static_cast<double>(steps[k]) * kCacheStep;
    }
    if (p.cwiseAbs().maxCoeff() > 1e9) from.complete = false;
    shown.positions.push_back(p);
  }
  return shown;
}

}  // namespace

SimCacheWriter::SimCacheWriter(const std::string& file, const Demo& demo) : name_(file), out_(file) {
  const std::string identity = identityText(demo);
  sim::Bytes head;
  sim::writeBytes(std::uint64_t{0}, head);
  sim::writeBytes(std::uint64_t{0}, head);
  sim::writeBytes(std::uint64_t{identity.size()}, head);
  put(titleLine());
  put(charactersOf(head));
  put(identity);
}

void SimCacheWriter::put(std::string_view bytes) {
  out_.write(bytes);
  written_ += bytes.size();
}

void SimCacheWriter::addRecord(const Demo& demo, bool key) {
  sim::Bytes body, head;
  for (const Actor& actor : demo.actors) writeShown(actor, demo.origin, body);
  const std::string state = key ? demoStateBytes(demo) : std::string();
  const auto bytes = std::as_bytes(std::span(state));
  body.insert(body.end(), bytes.begin(), bytes.end());
  sim::writeBytes(demo.shown_time, head);
  sim::writeBytes(sim::fingerprint(body), head);
  index_.push_back({demo.frames, written_, static_cast<std::uint32_t>(head.size() + body.size()), key ? 1u : 0u});
  put(charactersOf(head));
  put(charactersOf(body));
}

void SimCacheWriter::add(const Demo& demo) {
  if (!index_.empty() && demo.frames <= index_.back().frame) return;  // a run that was taken back
  addRecord(demo, index_.size() % kCacheKeyEvery == 0);
}

std::string SimCacheWriter::finish(const Demo& demo) {
  if (index_.empty()) throw OutputError(name_, "holds no frame", "let the hair move before the cache ends");
  // The last frame is one to go on from as well.
  if (index_.back().key == 0 && index_.back().frame == demo.frames) {
    index_.pop_back();
    addRecord(demo, true);
  }
  sim::Bytes index;
  for (const CacheFrame& entry : index_) {
    sim::writeBytes(entry.frame, index);
    sim::writeBytes(entry.at, index);
    sim::writeBytes(entry.bytes, index);
    sim::writeBytes(entry.key, index);
  }
  sim::writeBytes(sim::fingerprint(index), index);
  const std::uint64_t index_at = written_;
  put(charactersOf(index));
  sim::Bytes head;
  sim::writeBytes(index_at, head);
  sim::writeBytes(std::uint64_t{index_.size()}, head);
  out_.overwrite(static_cast<long>(kHeadAt), charactersOf(head));
  out_.commit();
  return countOf(index_.size(), "frame") + " cached in " + name_ + ", " + std::to_string((written_ + 512) / 1024) +
         " KB\n";
}

SimCache::SimCache(const std::string& file, const Demo& demo) : file_(file), stream_(file, std::ios::binary) {
  std::error_code error;
  const std::uint64_t size = std::filesystem::file_size(file, error);
  if (error || !stream_) throw InputError(file, "", "there is no such file, or it cannot be opened", "check the path");
  std::string title(titleLine().size(), '\0');
  stream_.read(title.data(), static_cast<std::streamsize>(title.size()));
  if (!title.starts_with(kCacheTitle)) throw InputError(file, "", "is no cache of simulated hair", kWriteAnew);
  if (title != titleLine()) throw InputError(file, "", "is a cache of another version", kWriteAnew);
  std::uint64_t index_at = 0, frames = 0, identity_size = 0;
  for (std::uint64_t* value : {&index_at, &frames, &identity_size})
    stream_.read(reinterpret_cast<char*>(value), sizeof *value);
  if (!stream_ || identity_size > std::min(size, kMaxIdentity)) throw InputError(file, "", "is cut off", kWriteAnew);
  std::string identity(identity_size, '\0');
  stream_.read(identity.data(), static_cast<std::streamsize>(identity_size));
  if (index_at == 0) throw InputError(file, "", "was never finished", kWriteAnew);
  if (!stream_ || index_at > size || frames == 0 || frames > (size - index_at) / kEntryBytes ||
      frames * kEntryBytes + 8 != size - index_at)
    throw InputError(file, "", "is cut off", kWriteAnew);
  if (identity != identityText(demo))
    throw InputError(
        file, "",
        "is of other hair: " + identity.substr(0, 200) + " where the scene has " + identityText(demo).substr(0, 200),
        "open the scene that it was written from");
  sim::Bytes bytes(frames * kEntryBytes + 8);
  stream_.seekg(static_cast<std::streamoff>(index_at));
  stream_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  sim::ByteReader from{bytes};
  for (std::uint64_t i = 0; i < frames; ++i) {
    CacheFrame& entry = index_.emplace_back();
    sim::readBytes(from, entry.frame);
    sim::readBytes(from, entry.at);
    sim::readBytes(from, entry.bytes);
    sim::readBytes(from, entry.key);
    const bool follows = i == 0 ? entry.key != 0 : entry.frame > index_[i - 1].frame;
    if (!follows || entry.at > index_at || entry.bytes > index_at - entry.at) from.complete = false;
  }
  std::uint64_t checksum = 0;
  sim::readBytes(from, checksum);
  if (!stream_ || !from.complete || checksum != sim::fingerprint(std::span(bytes).first(frames * kEntryBytes)))
    throw InputError(file, "index", "has been changed since it was written", kWriteAnew);
}

const CacheFrame& SimCache::entryOf(long frame, bool key) const {
  auto after = std::upper_bound(index_.begin(), index_.end(), frame,
                                [](long wanted, const CacheFrame& entry) { return wanted < entry.frame; });
  if (after == index_.begin())
    throw InputError(file_, "frame " + std::to_string(frame), "is before the first that is cached",
                     "go to frame " + std::to_string(first()) + " or later");
  --after;
  while (key && after->key == 0) --after;  // the first frame is one
  return *after;
}

std::string SimCache::record(const CacheFrame& entry) {
  std::string bytes(entry.bytes, '\0');
  stream_.clear();
  stream_.seekg(static_cast<std::streamoff>(entry.at));
  stream_.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  std::uint64_t checksum = 0;
  const auto all = std::as_bytes(std::span(bytes));
  if (bytes.size() >= 16) std::memcpy(&checksum, bytes.data() + 8, 8);
  if (!stream_ || bytes.size() < 16 || checksum != sim::fingerprint(all.subspan(16)))
    throw InputError(file_, "frame " + std::to_string(entry.frame), "has been changed since it was written",
                     kWriteAnew);
  return bytes;
}

void SimCache::resume(long frame, bool keep_view, Demo& demo) {
  const CacheFrame& entry = entryOf(frame, true);
  const std::string bytes = record(entry);
  sim::ByteReader from{std::as_bytes(std::span(bytes)).subspan(16)};
  for (const Actor& actor : demo.actors) readShown(actor, from);
  if (!from.complete) throw InputError(file_, "frame " + std::to_string(entry.frame), "is cut off", kWriteAnew);
  const std::string state = bytes.substr(bytes.size() - from.left.size());
  const bool paused = demo.paused;
  restoreDemoState(state, file_, keep_view, demo);
  demo.paused = paused;
}

void SimCache::show(long frame, Demo& demo) {
  const CacheFrame entry = entryOf(frame, false);
  const std::string bytes = record(entry);
  sim::ByteReader from{std::as_bytes(std::span(bytes)).subspan(16)};
  std::vector<ShownActor> shown;
  for (const Actor& actor : demo.actors) shown.push_back(readShown(actor, from));
  if (!from.complete) throw InputError(file_, "frame " + std::to_string(entry.frame), "is cut off", kWriteAnew);
  resume(frame, true, demo);
  std::memcpy(&demo.shown_time, bytes.data(), sizeof(double));
  demo.frames = static_cast<long>(entry.frame);
  demo.shown_fraction = -1;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    Actor& actor = demo.actors[i];
    actor.coarse.active = false;
    actor.pose.world = actor.previous_pose.world = shown[i].joints;
    actor.hair.positions = actor.previous_positions = shown[i].positions;
    actor.shown_still = actor.pose_still = false;
  }
}

bool isSimCache(const std::string& file) {
  std::string title(kCacheTitle.size(), '\0');
  return std::ifstream(file, std::ios::binary).read(title.data(), static_cast<std::streamsize>(title.size())) &&
         title == kCacheTitle;
}

}  // namespace app
