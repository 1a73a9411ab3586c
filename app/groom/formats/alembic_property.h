// How Alembic keeps properties in Ogawa groups: headers of properties and objects, samples with their digests.
//
// An object is a group: its compound of properties, its children, and their headers with 32 bytes of hashes at the end.
// A compound is a group: one group a property, and their headers. A property's group holds its samples: data that begin
// with a 16-byte digest, for arrays each followed by its dimensions (empty for one dimension, except of strings).
// A header is a 32-bit word (bits 0-1 kind, 2-3 bytes of its numbers as a power of two, 4-7 type, 8 has a time
// sampling, 9 tells first and last change, 10 homogeneous, 11 constant, 12-19 extent, 20-27 index of its metadata, 255:
// written out), number of samples, first and last changed sample, time sampling, name, metadata. Metadata are
// "key=value;key=value". Source: lib/Alembic/AbcCoreOgawa (WriteUtil, ReadUtil, AwImpl, OwData, CpwData, ApwImpl,
// MetaDataMap) of the repository alembic/alembic.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "app/groom/formats/ogawa.h"

namespace app::alembic {

enum class Pod : std::uint8_t {
  kBool,
  kUint8,
  kInt8,
  kUint16,
  kInt16,
  kUint32,
  kInt32,
  kUint64,
  kInt64,
  kFloat16,
  kFloat32,
  kFloat64,
  kString,
  kWstring
};
// Bytes of one number; 0 for strings.
std::size_t podBytes(Pod pod);

enum class Kind : std::uint8_t { kCompound = 0, kScalar = 1, kArray = 2 };

struct Property {
  std::string name, metadata;
  Kind kind = Kind::kCompound;
  Pod pod = Pod::kInt8;
  unsigned extent = 1;  // numbers an element
  std::uint32_t sample_count = 0;
  std::uint32_t first_changed = 0;  // samples before it are the first one's data
  std::uint32_t last_changed = 0;   // samples after it are this one's data
  std::uint32_t time_sampling = 0;
  std::uint64_t group = 0;  // offset of its samples or of its compound
};

struct Object {
  std::string name, metadata;
  std::uint64_t group = 0;
};

// Metadata strings that headers refer to by number. Number 0 is the empty string.
class MetadataTable {
 public:
  // 255 when the string is to be written out.
  unsigned index(const std::string& metadata);
  // What the root group keeps, and reading it again. Throws InputError.
  std::string bytes() const;
  void read(std::string_view bytes, const OgawaReader& file);
  // Throws InputError for a number beyond the table.
  const std::string& text(unsigned index, const OgawaReader& file) const;

 private:
  std::vector<std::string> texts_{""};
  std::map<std::string, unsigned> indices_;
};

// The value of a key, or empty.
std::string metadataValue(std::string_view metadata, std::string_view key);

// Of a compound's children, in their order.
std::string propertyHeaders(const std::vector<Property>& properties, MetadataTable& table);
std::vector<Property> readProperties(std::uint64_t compound, const MetadataTable& table, OgawaReader& file);

// Of an object's children. `hash` distinguishes objects of different content.
std::string objectHeaders(const std::vector<Object>& objects, std::uint64_t hash, MetadataTable& table);
std::vector<Object> readObjects(const std::vector<std::uint64_t>& children, const MetadataTable& table,
                                OgawaReader& file);

// A sample's data block: digest and bytes. Readers take equal digests for equal samples; any good hash will do.
std::uint64_t writeSample(std::string_view bytes, OgawaWriter& writer);
// The bytes of sample `index` (clamped to the last) of a scalar or array without its digest. Throws InputError.
std::string_view readSample(const Property& property, std::uint32_t index, OgawaReader& file);

// 64 bits of a hash over `bytes`.
std::uint64_t contentHash(std::string_view bytes, std::uint64_t seed);

}  // namespace app::alembic
