#include "render/gl/gpu_timer.h"

#include <cstddef>

#include "render/gl/driver.h"

namespace render {

void GpuTimer::start(bool measure) {
  measure_ = measure;
  names_.clear();
  clocks_.clear();
  if (!measure_) return;
  if (!decided_) {
    software_ = rasterizesInSoftware();
    decided_ = true;
  }
  mark(nullptr);
}

void GpuTimer::mark(const char* stage) {
  if (!measure_) return;
  const std::size_t index = names_.size();
  names_.push_back(stage);
  if (software_) {
    glFinish();
    clocks_.push_back(std::chrono::steady_clock::now());
    return;
  }
  if (index >= queries_.size()) queries_.push_back(makeQuery(GL_TIMESTAMP));
  glQueryCounter(queries_[index].id(), GL_TIMESTAMP);
}

std::vector<StageTime> GpuTimer::finish() {
  std::vector<StageTime> stages;
  for (std::size_t i = 1; i < names_.size(); ++i) {
    double milliseconds = 0;
    if (software_) {
      milliseconds = std::chrono::duration<double, std::milli>(clocks_[i] - clocks_[i - 1]).count();
    } else {
      GLuint64 from = 0, to = 0;
      glGetQueryObjectui64v(queries_[i - 1].id(), GL_QUERY_RESULT, &from);
      glGetQueryObjectui64v(queries_[i].id(), GL_QUERY_RESULT, &to);
      milliseconds = static_cast<double>(to - from) * 1e-6;
    }
    stages.push_back({names_[i], milliseconds});
  }
  return stages;
}

}  // namespace render
