# cmake --install: the command, the rooms as libraries, the headers and the cases; find_package(treacle) gives the
# target treacle::treacle, which is all rooms together (docs/design.md; tests/install uses it as a stranger would).
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/treacle)

get_property(rooms GLOBAL PROPERTY TREACLE_ROOMS)
add_library(treacle_library INTERFACE)
set_target_properties(treacle_library PROPERTIES EXPORT_NAME treacle)
target_link_libraries(treacle_library INTERFACE ${rooms})

install(TARGETS treacle)
install(TARGETS treacle_library ${rooms} EXPORT treacleTargets)
install(EXPORT treacleTargets NAMESPACE treacle:: DESTINATION ${package_dir})
install(DIRECTORY include/treacle DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN *.hpp)
install(DIRECTORY cases DESTINATION ${CMAKE_INSTALL_DATADIR}/treacle FILES_MATCHING PATTERN *.toml PATTERN *.stl)

configure_package_config_file(cmake/treacleConfig.cmake.in ${CMAKE_BINARY_DIR}/treacleConfig.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/treacleConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/treacleConfig.cmake ${CMAKE_BINARY_DIR}/treacleConfigVersion.cmake
  DESTINATION ${package_dir})
