# What find_package(hairmesh CONFIG) reads: hairmesh::hairmesh and hairmesh::static, the C interface, which need no other
# package; and hairmesh::sim, the simulator for C++, where Eigen is found. find_package(hairmesh COMPONENTS sim) asks for it.
include(${CMAKE_CURRENT_LIST_DIR}/hairmesh-targets.cmake)
find_package(Eigen3 3.4 QUIET NO_MODULE)
if(Eigen3_FOUND)
  include(${CMAKE_CURRENT_LIST_DIR}/hairmesh-sim-targets.cmake)
  set(hairmesh_sim_FOUND TRUE)
elseif(sim IN_LIST hairmesh_FIND_COMPONENTS AND hairmesh_FIND_REQUIRED_sim)
  set(hairmesh_FOUND FALSE)
  set(hairmesh_NOT_FOUND_MESSAGE "hairmesh::sim needs Eigen 3.4 (Debian: libeigen3-dev)")
endif()
