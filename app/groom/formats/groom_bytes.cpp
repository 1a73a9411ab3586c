#include "app/groom/formats/groom_bytes.h"

#include <algorithm>

#include "app/files/errors.h"

namespace app {

void checkGroomSize(const std::string& file, const std::string& place, std::size_t strands, std::size_t points) {
  if (points <= kMaxGroomPoints && strands <= kMaxGroomPoints) return;
  const double share = static_cast<double>(kMaxGroomPoints) / static_cast<double>(std::max(points, strands));
  const auto fit = static_cast<std::size_t>(share * static_cast<double>(strands));
  throw InputError(file, place,
                   "holds " + std::to_string(strands) + " strands and " + std::to_string(points) + " points in all; " +
                       std::to_string(fit) + " such strands fit (" + std::to_string(kMaxGroomPoints) + " points)",
                   "export fewer strands or fewer points a strand");
}

void ByteReader::seek(std::size_t offset, const char* what) {
  if (offset > bytes.size()) {
    fail(std::string(what) + " should stand at byte " + std::to_string(offset) + ", beyond the file's " +
             std::to_string(bytes.size()),
         "the file is damaged or cut off; export it again");
  }
  at = offset;
}

void ByteReader::need(std::size_t count, std::size_t size, const char* what) const {
  if (count <= left() / size) return;
  fail("the file ends where " + std::string(what) + " should stand (" + std::to_string(count) +
           (size > 1 ? " times " + std::to_string(size) : "") + " bytes; " + std::to_string(left()) + " are left)",
       "the file is damaged or cut off; export it again");
}

void ByteReader::fail(const std::string& fault, const std::string& mend) const {
  throw InputError(file, "byte " + std::to_string(at), fault, mend);
}

}  // namespace app
