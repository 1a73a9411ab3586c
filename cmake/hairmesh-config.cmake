# What find_package(hairmesh CONFIG) reads: hairmesh::sim, the simulator, which needs Eigen only.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 3.4 NO_MODULE)
include(${CMAKE_CURRENT_LIST_DIR}/hairmesh-targets.cmake)
