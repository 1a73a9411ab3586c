#include "app/files/errors.h"

namespace app {

namespace {
std::string message(const std::string& file, const std::string& place, const std::string& fault,
                    const std::string& mend) {
  std::string text = file;
  if (!place.empty()) text += (text.empty() ? "" : ": ") + place;
  text += (text.empty() ? "" : ": ") + fault;
  if (!mend.empty()) text += "; " + mend;
  return text;
}
}  // namespace

InputError::InputError(const std::string& file, const std::string& place, const std::string& fault,
                       const std::string& mend)
    : std::runtime_error(message(file, place, fault, mend)), of_file(!file.empty()) {}

OutputError::OutputError(const std::string& file, const std::string& fault, const std::string& mend)
    : std::runtime_error(message(file, "", fault, mend)) {}

}  // namespace app
