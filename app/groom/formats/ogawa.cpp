#include "app/groom/formats/ogawa.h"

#include <algorithm>
#include <cstring>

#include "app/files/errors.h"
#include "app/groom/formats/groom_bytes.h"

namespace app {

namespace {

constexpr std::string_view kMagic = "Ogawa";
constexpr std::size_t kHeader = 16, kFinishedAt = 5, kRootAt = 8;
constexpr std::uint64_t kSmallVisits = 1024;  // that any file may take

}  // namespace

OgawaWriter::OgawaWriter(OutputFile& output) : output_(output) {
  append(kMagic);
  append(std::string_view("\0\0\1", 3));
  append(bytesOf(std::uint64_t{0}));
}

void OgawaWriter::append(std::string_view bytes) {
  output_.write(bytes);
  end_ += bytes.size();
}

std::uint64_t OgawaWriter::data(std::initializer_list<std::string_view> pieces) {
  std::uint64_t size = 0;
  for (const std::string_view piece : pieces) size += piece.size();
  if (size == 0) return kOgawaData;
  const std::uint64_t at = end_;
  append(bytesOf(size));
  for (const std::string_view piece : pieces) append(piece);
  return at | kOgawaData;
}

std::uint64_t OgawaWriter::group(const std::vector<std::uint64_t>& children) {
  if (children.empty()) return 0;
  const std::uint64_t at = end_;
  append(bytesOf(std::uint64_t{children.size()}));
  append(bytesOf(children));
  return at;
}

void OgawaWriter::finish(std::uint64_t root) {
  output_.overwrite(kRootAt, bytesOf(root));
  output_.overwrite(kFinishedAt, "\xff");
}

OgawaReader::OgawaReader(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file) {
  if (bytes.size() < kHeader || !bytes.starts_with(kMagic)) fail(0, "the 16 bytes of an Ogawa header are missing");
  if (bytes[kFinishedAt] != '\xff') fail(kFinishedAt, "the file was not written to its end");
  if (bytes[6] != 0 || bytes[7] != 1) fail(6, "the Ogawa version is not 1");
  root_ = number(kRootAt, "the root group");
}

std::uint64_t OgawaReader::number(std::uint64_t offset, const char* what) const {
  if (offset > bytes_.size() || bytes_.size() - offset < sizeof(std::uint64_t)) {
    fail(std::min<std::uint64_t>(offset, bytes_.size()),
         std::string("the file ends before ") + what + " that should stand at byte " + std::to_string(offset));
  }
  std::uint64_t value = 0;
  std::memcpy(&value, bytes_.data() + offset, sizeof value);
  return value;
}

std::vector<std::uint64_t> OgawaReader::children(std::uint64_t group) {
  if (isData(group)) fail(group & ~kOgawaData, "data stands where a group should");
  if (group == 0) return {};
  const std::uint64_t count = number(group, "a group");
  const std::uint64_t first = group + sizeof count;
  if (count > (bytes_.size() - first) / sizeof count) fail(group, "a group reaches beyond the end of the file");
  visits_ += count + 1;
  if (visits_ > bytes_.size() + kSmallVisits) fail(group, "groups lead in a circle");
  std::vector<std::uint64_t> offsets(count);
  if (count > 0) std::memcpy(offsets.data(), bytes_.data() + first, count * sizeof count);
  return offsets;
}

std::string_view OgawaReader::data(std::uint64_t block) const {
  const std::uint64_t offset = block & ~kOgawaData;
  if (!isData(block)) fail(offset, "a group stands where data should");
  if (offset == 0) return {};
  const std::uint64_t size = number(offset, "data");
  const std::uint64_t first = offset + sizeof size;
  if (size > bytes_.size() - first) fail(offset, "data reach beyond the end of the file");
  return bytes_.substr(first, size);
}

void OgawaReader::fail(std::uint64_t offset, const std::string& fault) const {
  throw InputError(file_, "byte " + std::to_string(offset), fault, "the file is damaged or cut off; export it again");
}

}  // namespace app
