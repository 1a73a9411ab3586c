// What was made last, so that the same is not made again: scenes opened one after another, or compared, mostly show the
// same figure with the same roots.
#pragma once

#include <algorithm>
#include <list>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "app/figure/character.h"

namespace app {

// The values of the last four keys; from any thread.
template <class Value>
class Kept {
 public:
  // A copy of the value of that key; it is made where it is not there.
  template <class Make>
  Value get(const std::string& key, const Make& make) {
    {
      const std::lock_guard lock(mutex_);
      const auto found = std::ranges::find(kept_, key, &std::pair<std::string, Value>::first);
      if (found != kept_.end()) {
        kept_.splice(kept_.begin(), kept_, found);
        return found->second;
      }
    }
    Value made = make();
    const std::lock_guard lock(mutex_);
    kept_.emplace_front(key, made);
    if (kept_.size() > 4) kept_.pop_back();
    return made;
  }

 private:
  std::mutex mutex_;
  std::list<std::pair<std::string, Value>> kept_;  // the latest first
};

template <class T>
void addBytes(const std::vector<T>& values, std::string& key) {
  key.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

// For a key: the bytes of the surface in its rest pose, and of where scalp frame and scalp are.
std::string restSurfaceBytes(const Character& character);

}  // namespace app
