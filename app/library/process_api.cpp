// The library itself: version, messages, log.
#include <cstdio>
#include <cstring>
#include <mutex>
#include <stdexcept>

#include "app/files/errors.h"
#include "app/library/fault.h"
#include "app/library/log.h"
#include "sim/mesh/hair_mesh.h"

namespace app::library {
namespace {

thread_local char last_message[1024] = "";

struct LogTarget {
  hm_log log = nullptr;
  void* user = nullptr;
};
std::mutex log_lock;
LogTarget log_target;

}  // namespace

void writeLog(hm_log_level level, const char* message) noexcept {
  LogTarget target;
  {
    const std::lock_guard lock(log_lock);
    target = log_target;
  }
  if (target.log) target.log(level, message, target.user);
}

hm_result fail(hm_result result, const char* function, const char* text) noexcept {
  std::snprintf(last_message, sizeof last_message, "%s: %s", function, text);
  writeLog(HM_LOG_ERROR, last_message);
  return result;
}

hm_result failWithCurrentException(const char* function) noexcept {
  try {
    throw;
  } catch (const Fault& fault) {
    return fail(fault.result, function, fault.text.c_str());
  } catch (const sim::MeshError& error) {
    return fail(HM_ERROR_MESH, function, error.what());
  } catch (const InputError& error) {
    return fail(HM_ERROR_TEXT, function, error.what());
  } catch (const std::bad_alloc&) {
    return fail(HM_ERROR_MEMORY, function, "there is not enough memory; destroy what is no longer needed");
  } catch (const std::length_error&) {
    return fail(HM_ERROR_MEMORY, function, "more memory is asked for than there can be; ask for less");
  } catch (const std::exception& error) {
    return fail(HM_ERROR_INTERNAL, function, error.what());
  } catch (...) {
    return fail(HM_ERROR_INTERNAL, function, "an unknown fault; please report it");
  }
}

}  // namespace app::library

using namespace app::library;

int32_t hm_version(void) {
  return HM_VERSION_MAJOR * 10000 + HM_VERSION_MINOR * 100 + HM_VERSION_PATCH;
}

const char* hm_result_name(hm_result result) {
  static constexpr const char* kNames[] = {
      "HM_OK",           "HM_ERROR_ARGUMENT",    "HM_ERROR_HANDLE",  "HM_ERROR_BUSY", "HM_ERROR_SIZE",
      "HM_ERROR_VALUE",  "HM_ERROR_NAME",        "HM_ERROR_MESH",    "HM_ERROR_TEXT", "HM_ERROR_STATE",
      "HM_ERROR_MEMORY", "HM_ERROR_UNSUPPORTED", "HM_ERROR_INTERNAL"};
  unsigned number = 0;  // any number may come from C
  std::memcpy(&number, &result, sizeof number);
  return number < sizeof kNames / sizeof *kNames ? kNames[number] : "no result of this library";
}

const char* hm_error_message(void) {
  return last_message;
}

void hm_set_log(hm_log log, void* user) {
  const std::lock_guard lock(log_lock);
  log_target = {log, user};
}
