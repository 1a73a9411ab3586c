// What a person tells of a body without bones.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>

namespace app {

// In place of what its outline tells (app/figure/still_body.h): "unit=cm up=z face=-x" or a part of that.
struct ToldBody {
  double unit = 0;                                 // m in a unit of the file; 0: not told
  char up = 0;                                     // 'y', 'z'; 0: not told
  Eigen::Vector3d face = Eigen::Vector3d::Zero();  // where it looks, once y is up; zero: not told
};

// What `text` tells. Returns what is wrong with it, empty when fine.
std::string readToldBody(std::string_view text, ToldBody& told);
std::string writeToldBody(const ToldBody& told);

}  // namespace app
