#include "app/groom/formats/alembic_property.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "app/groom/formats/groom_bytes.h"

namespace app::alembic {

namespace {

constexpr std::size_t kDigest = 16, kHashes = 32;
constexpr unsigned kWrittenOut = 255;
constexpr std::uint32_t kHasTimeSampling = 0x100, kHasChanges = 0x200, kHomogeneous = 0x400, kConstant = 0x800;

// A number of 1, 2 or 4 bytes: 1 << hint.
void putNumber(std::string& bytes, std::uint32_t value, unsigned hint) {
  bytes.append(bytesOf(value).substr(0, std::size_t{1} << hint));
}

// A cursor over headers: every read is checked against their end.
struct HeaderReader {
  std::string_view bytes;
  const OgawaReader& file;
  std::size_t at = 0;

  bool done() const { return at == bytes.size(); }
  std::string_view text(std::size_t size) {
    if (size > bytes.size() - at) file.fail(0, "headers of properties or objects are cut off");
    at += size;
    return bytes.substr(at - size, size);
  }
  std::uint32_t number(unsigned hint) {
    std::uint32_t value = 0;
    const std::string_view piece = text(std::size_t{1} << hint);
    std::memcpy(&value, piece.data(), piece.size());
    return value;
  }
};

bool isConstant(const Property& property) {
  return property.first_changed == 0 && property.last_changed == 0;
}
bool changesAlways(const Property& property) {
  return property.first_changed == 1 && property.last_changed + 1 == property.sample_count;
}

std::uint32_t headerWord(const Property& property, unsigned hint, unsigned metadata) {
  std::uint32_t word = hint << 2 | metadata << 20;
  if (property.kind == Kind::kCompound) return word;
  word |= static_cast<std::uint32_t>(property.kind) | static_cast<std::uint32_t>(property.pod) << 4;
  word |= property.extent << 12 | kHomogeneous;
  if (property.time_sampling != 0) word |= kHasTimeSampling;
  if (isConstant(property)) return word | kConstant;
  return changesAlways(property) ? word : word | kHasChanges;
}

Property readHeader(HeaderReader& reader, const MetadataTable& table, const OgawaReader& file) {
  const std::uint32_t word = reader.number(2);
  const unsigned hint = word >> 2 & 3, kind = word & 3;
  if (hint > 2) file.fail(0, "a property's header has numbers of 8 bytes");
  Property property;
  property.kind = kind == 0 ? Kind::kCompound : kind == 1 ? Kind::kScalar : Kind::kArray;
  if (kind != 0) {
    property.pod = static_cast<Pod>(word >> 4 & 15);
    property.extent = word >> 12 & 255;
    property.sample_count = reader.number(hint);
    property.first_changed = 1;
    property.last_changed = property.sample_count - std::min(1u, property.sample_count);
    if (word & kHasChanges) {
      property.first_changed = reader.number(hint);
      property.last_changed = reader.number(hint);
    } else if (word & kConstant) {
      property.first_changed = property.last_changed = 0;
    }
    if (word & kHasTimeSampling) property.time_sampling = reader.number(hint);
  }
  property.name = reader.text(reader.number(hint));
  const unsigned metadata = word >> 20 & 255;
  property.metadata =
      metadata == kWrittenOut ? std::string(reader.text(reader.number(hint))) : table.text(metadata, file);
  return property;
}

}  // namespace

std::size_t podBytes(Pod pod) {
  constexpr std::array<std::size_t, 16> kBytes{1, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8, 0, 0, 0, 0};
  return kBytes[static_cast<unsigned>(pod) & 15];
}

unsigned MetadataTable::index(const std::string& metadata) {
  if (metadata.empty()) return 0;
  if (metadata.size() > 255) return kWrittenOut;
  const auto found = indices_.find(metadata);
  if (found != indices_.end()) return found->second;
  if (texts_.size() == kWrittenOut) return kWrittenOut;
  indices_[metadata] = static_cast<unsigned>(texts_.size());
  texts_.push_back(metadata);
  return static_cast<unsigned>(texts_.size() - 1);
}

std::string MetadataTable::bytes() const {
  std::string all;
  for (std::size_t n = 1; n < texts_.size(); ++n) all.append(1, static_cast<char>(texts_[n].size())).append(texts_[n]);
  return all;
}

void MetadataTable::read(std::string_view bytes, const OgawaReader& file) {
  HeaderReader reader{bytes, file};
  while (!reader.done()) texts_.emplace_back(reader.text(reader.number(0)));
}

const std::string& MetadataTable::text(unsigned index, const OgawaReader& file) const {
  if (index >= texts_.size()) file.fail(0, "a header names metadata that the file has not");
  return texts_[index];
}

std::string metadataValue(std::string_view metadata, std::string_view key) {
  while (!metadata.empty()) {
    const std::string_view pair = metadata.substr(0, metadata.find(';'));
    if (pair.starts_with(key) && pair.size() > key.size() && pair[key.size()] == '=')
      return std::string(pair.substr(key.size() + 1));
    metadata.remove_prefix(std::min(metadata.size(), pair.size() + 1));
  }
  return "";
}

std::string propertyHeaders(const std::vector<Property>& properties, MetadataTable& table) {
  std::string bytes;
  for (const Property& property : properties) {
    const std::size_t largest = std::max({property.name.size(), property.metadata.size(),
                                          std::size_t{property.sample_count}, std::size_t{property.time_sampling}});
    const unsigned hint = largest > 65535 ? 2 : largest > 255 ? 1 : 0;
    const unsigned metadata = table.index(property.metadata);
    putNumber(bytes, headerWord(property, hint, metadata), 2);
    if (property.kind != Kind::kCompound) {
      putNumber(bytes, property.sample_count, hint);
      if (!isConstant(property) && !changesAlways(property)) {
        putNumber(bytes, property.first_changed, hint);
        putNumber(bytes, property.last_changed, hint);
      }
      if (property.time_sampling != 0) putNumber(bytes, property.time_sampling, hint);
    }
    putNumber(bytes, static_cast<std::uint32_t>(property.name.size()), hint);
    bytes += property.name;
    if (metadata != kWrittenOut) continue;
    putNumber(bytes, static_cast<std::uint32_t>(property.metadata.size()), hint);
    bytes += property.metadata;
  }
  return bytes;
}

std::vector<Property> readProperties(std::uint64_t compound, const MetadataTable& table, OgawaReader& file) {
  const std::vector<std::uint64_t> children = file.children(compound);
  if (children.empty() || !OgawaReader::isData(children.back())) return {};
  HeaderReader reader{file.data(children.back()), file};
  std::vector<Property> properties;
  while (!reader.done()) {
    if (properties.size() + 1 >= children.size()) file.fail(compound, "a compound has more headers than properties");
    properties.push_back(readHeader(reader, table, file));
    properties.back().group = children[properties.size() - 1];
  }
  return properties;
}

std::string objectHeaders(const std::vector<Object>& objects, std::uint64_t hash, MetadataTable& table) {
  std::string bytes;
  for (const Object& object : objects) {
    putNumber(bytes, static_cast<std::uint32_t>(object.name.size()), 2);
    bytes += object.name;
    const unsigned metadata = table.index(object.metadata);
    putNumber(bytes, metadata, 0);
    if (metadata != kWrittenOut) continue;
    putNumber(bytes, static_cast<std::uint32_t>(object.metadata.size()), 2);
    bytes += object.metadata;
  }
  // Hash of the properties and hash of the children, 16 bytes each.
  for (std::uint64_t n = 0; n < kHashes / sizeof hash; ++n) bytes.append(bytesOf(contentHash(bytesOf(n), hash)));
  return bytes;
}

std::vector<Object> readObjects(const std::vector<std::uint64_t>& children, const MetadataTable& table,
                                OgawaReader& file) {
  if (children.empty() || !OgawaReader::isData(children.back())) return {};
  const std::string_view all = file.data(children.back());
  HeaderReader reader{all.substr(0, all.size() - std::min(all.size(), kHashes)), file};
  std::vector<Object> objects;
  while (!reader.done()) {
    if (objects.size() + 2 >= children.size()) file.fail(0, "an object has more headers than children");
    Object object;
    object.name = reader.text(reader.number(2));
    const unsigned metadata = reader.number(0);
    object.metadata = metadata == kWrittenOut ? std::string(reader.text(reader.number(2))) : table.text(metadata, file);
    object.group = children[objects.size() + 1];
    objects.push_back(std::move(object));
  }
  return objects;
}

std::uint64_t contentHash(std::string_view bytes, std::uint64_t seed) {
  std::uint64_t hash = seed ^ bytes.size() * 0x9e3779b97f4a7c15ull;
  std::size_t at = 0;
  const auto mix = [&hash](std::uint64_t word) {
    hash = std::rotl((hash ^ word) * 0xff51afd7ed558ccdull, 31) * 0xc4ceb9fe1a85ec53ull;
  };
  for (; at + 8 <= bytes.size(); at += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + at, 8);
    mix(word);
  }
  std::uint64_t tail = 0;
  if (at < bytes.size()) std::memcpy(&tail, bytes.data() + at, bytes.size() - at);
  mix(tail);
  return hash ^ hash >> 29;
}

std::uint64_t writeSample(std::string_view bytes, OgawaWriter& writer) {
  if (bytes.empty()) return kOgawaData;
  const std::array<std::uint64_t, 2> digest{contentHash(bytes, 1), contentHash(bytes, 2)};
  static_assert(sizeof digest == kDigest);
  return writer.data({bytesOf(digest), bytes});
}

std::string_view readSample(const Property& property, std::uint32_t index, OgawaReader& file) {
  const std::uint32_t last = property.sample_count - std::min(1u, property.sample_count);
  index = std::min({index, last, property.last_changed});
  const std::uint32_t stored =
      index < property.first_changed || property.last_changed == 0 ? 0 : index - property.first_changed + 1;
  const std::size_t stride = property.kind == Kind::kArray ? 2 : 1;
  const std::vector<std::uint64_t> samples = file.children(property.group);
  if (stored * stride >= samples.size()) file.fail(property.group, "property '" + property.name + "' lacks a sample");
  const std::string_view all = file.data(samples[stored * stride]);
  if (all.empty()) return all;
  if (all.size() < kDigest) file.fail(samples[stored * stride] & ~kOgawaData, "a sample is shorter than its digest");
  return all.substr(kDigest);
}

}  // namespace app::alembic
