# What find_package(hairmesh CONFIG) gives: hairmesh::sim, the simulator for C++ with Eigen (examples/hello); and the C
# interface of include/hairmesh.h, hairmesh::hairmesh (shared) and hairmesh::static, which need no other package.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
include(CheckCXXSourceCompiles)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/hairmesh)

# The header's version is the project's.
foreach(part MAJOR MINOR PATCH)
  file(STRINGS include/hairmesh.h line REGEX "^#define HM_VERSION_${part} ")
  if(NOT line STREQUAL "#define HM_VERSION_${part} ${PROJECT_VERSION_${part}}")
    message(FATAL_ERROR "include/hairmesh.h: '${line}' is not version ${PROJECT_VERSION} of CMakeLists.txt; change one of them")
  endif()
endforeach()

add_library(hairmesh::sim ALIAS hair_sim)
set_target_properties(hair_sim PROPERTIES EXPORT_NAME sim OUTPUT_NAME hairmesh_sim)

# What the program does not have as well.
file(GLOB library_sources CONFIGURE_DEPENDS app/library/*.cpp)
file(GLOB style_sources CONFIGURE_DEPENDS app/styles/*.cpp)
set(allocator_source ${CMAKE_CURRENT_SOURCE_DIR}/app/library/allocator.cpp)
list(REMOVE_ITEM library_sources ${allocator_source})
add_library(hairmesh_objects OBJECT ${library_sources} ${style_sources}
  app/files/errors.cpp app/files/hair_file.cpp app/files/obj_layers.cpp app/files/text_scanner.cpp
  app/scene/view/look_params.cpp app/scene/edit/render_faces.cpp)
target_link_libraries(hairmesh_objects PRIVATE hair_options Eigen3::Eigen)
target_precompile_headers(hairmesh_objects REUSE_FROM hair_sim)
compile_rooms_as_one(hairmesh_objects)
set(all_objects $<TARGET_OBJECTS:hair_sim> $<TARGET_OBJECTS:hair_strands> $<TARGET_OBJECTS:hairmesh_objects>)

add_library(hairmesh_shared SHARED ${all_objects} ${allocator_source})
add_library(hairmesh_static STATIC ${all_objects} ${allocator_source})
add_library(hairmesh::hairmesh ALIAS hairmesh_shared)
add_library(hairmesh::static ALIAS hairmesh_static)
foreach(target hairmesh_shared hairmesh_static)
  set_target_properties(${target} PROPERTIES OUTPUT_NAME hairmesh)
endforeach()
foreach(target hairmesh_shared hairmesh_static)
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:hair_options> $<BUILD_INTERFACE:Eigen3::Eigen>)
  target_include_directories(${target} INTERFACE $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
endforeach()

# As long as the major version is 0, a minor one may change the layout: it names the library.
set_target_properties(hairmesh_shared PROPERTIES VERSION ${PROJECT_VERSION}
  SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} EXPORT_NAME hairmesh
  LINK_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/cmake/hairmesh.map)
set_target_properties(hairmesh_static PROPERTIES EXPORT_NAME static)
if(CMAKE_SYSTEM_NAME STREQUAL Linux)
  # The interface alone is seen. hm_set_allocator reaches all memory where the C++ runtime is a part of the library.
  target_link_options(hairmesh_shared PRIVATE -Wl,--version-script=${CMAKE_CURRENT_SOURCE_DIR}/cmake/hairmesh.map
    -Wl,--no-undefined)
  set(CMAKE_REQUIRED_LINK_OPTIONS -static-libstdc++ -static-libgcc)
  check_cxx_source_compiles("#include <string>\nint main(int n, char** a) { return std::string(a[0]).size() < unsigned(n); }"
    HAIRMESH_STATIC_RUNTIME)
  unset(CMAKE_REQUIRED_LINK_OPTIONS)
  if(HAIRMESH_STATIC_RUNTIME AND NOT HAIRMESH_SANITIZE)
    set(wrapped malloc free calloc realloc aligned_alloc memalign posix_memalign)
    list(TRANSFORM wrapped PREPEND -Wl,--wrap=)
    target_link_options(hairmesh_shared PRIVATE -static-libstdc++ -static-libgcc ${wrapped})
    target_compile_definitions(hairmesh_shared PRIVATE HAIRMESH_WRAPS_MALLOC)
  endif()
  # What a program in C has to link with the static library.
  target_link_libraries(hairmesh_static INTERFACE $<INSTALL_INTERFACE:stdc++> $<INSTALL_INTERFACE:m>)
endif()

write_basic_package_version_file(hairmesh-config-version.cmake COMPATIBILITY SameMinorVersion)
install(TARGETS hair_sim EXPORT hairmesh-sim ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
install(TARGETS hairmesh_shared EXPORT hairmesh
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT development)
install(TARGETS hairmesh_static EXPORT hairmesh ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
install(EXPORT hairmesh-sim NAMESPACE hairmesh:: FILE hairmesh-sim-targets.cmake DESTINATION ${package_folder}
  COMPONENT development)
install(EXPORT hairmesh NAMESPACE hairmesh:: FILE hairmesh-targets.cmake DESTINATION ${package_folder}
  COMPONENT development)
file(RELATIVE_PATH PACKAGE_SHADERS /${package_folder} /${CMAKE_INSTALL_DATADIR}/hairmesh/shaders)
configure_file(cmake/hairmesh-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/hairmesh-config.cmake @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/hairmesh-config.cmake
  ${CMAKE_CURRENT_BINARY_DIR}/hairmesh-config-version.cmake
  DESTINATION ${package_folder} COMPONENT development)
install(FILES include/hairmesh.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
install(DIRECTORY sim DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/hairmesh COMPONENT development
  FILES_MATCHING PATTERN "*.h")
install(DIRECTORY app/library/python/hairmesh DESTINATION lib/python3/dist-packages COMPONENT python
  FILES_MATCHING PATTERN "*.py" PATTERN "__pycache__" EXCLUDE)

# Under the name that Debian asks for, with every package.
set(soname_version ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(package_names library libhairmesh${soname_version} development libhairmesh-dev python python3-hairmesh)
if(HAIRMESH_APP)
  list(APPEND package_names program hairmesh)
endif()
set(components "")
while(package_names)
  list(POP_FRONT package_names component package)
  list(APPEND components ${component})
  install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} RENAME copyright COMPONENT ${component})
endwhile()
# An unknown component installs nothing, and CMake does not say so. A project around this one has components of its own.
if(PROJECT_IS_TOP_LEVEL)
  list(JOIN components ", " component_words)
  list(JOIN components "|" component_pattern)
  install(CODE "
    if(CMAKE_INSTALL_COMPONENT AND NOT \"\${CMAKE_INSTALL_COMPONENT}\" MATCHES \"^(${component_pattern})$\")
      message(FATAL_ERROR \"hairmesh has no component '\${CMAKE_INSTALL_COMPONENT}'; it has ${component_words}\")
    endif()" ALL_COMPONENTS)
endif()

# cpack -G DEB: libhairmesh0.1, libhairmesh-dev, python3-hairmesh and, of a build with the program, hairmesh.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME hairmesh)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Real-time hair mesh simulation")
set(CPACK_PACKAGE_CONTACT "the hairmesh project")
set(CPACK_RESOURCE_FILE_LICENSE ${CMAKE_CURRENT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_COMPONENTS_ALL library development python)
if(HAIRMESH_APP)
  list(APPEND CPACK_COMPONENTS_ALL program)
endif()
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libhairmesh${soname_version})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS libc6)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libhairmesh-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "libhairmesh${soname_version} (= ${PROJECT_VERSION}), libeigen3-dev (>= 3.4)")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS libglew-dev)
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-hairmesh)
set(CPACK_DEBIAN_PYTHON_PACKAGE_ARCHITECTURE all)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "libhairmesh${soname_version} (>= ${PROJECT_VERSION}), python3-numpy")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-distributed, python3-matplotlib")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME hairmesh)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS ffmpeg)
include(CPack)
