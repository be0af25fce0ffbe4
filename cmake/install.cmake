# cmake --install: the command, the rooms as libraries, the headers and the cases; find_package(treacle) gives the
# target treacle::treacle, which is all rooms together (docs/design.md; tests/install uses it as a stranger would).
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/treacle)

get_property(rooms GLOBAL PROPERTY TREACLE_ROOMS)
add_library(treacle_library INTERFACE)
set_target_properties(treacle_library PROPERTIES EXPORT_NAME treacle)
target_link_libraries(treacle_library INTERFACE ${rooms})

# Shared rooms are found from where the program, the module and the other rooms lie.
if(TREACLE_SHARED AND NOT SKBUILD)
  file(RELATIVE_PATH libraries /prefix/${CMAKE_INSTALL_BINDIR} /prefix/${CMAKE_INSTALL_LIBDIR})
  set_target_properties(treacle PROPERTIES INSTALL_RPATH "$ORIGIN/${libraries}")
  set_target_properties(${rooms} PROPERTIES INSTALL_RPATH "$ORIGIN")
  if(TREACLE_PYTHON)
    file(RELATIVE_PATH libraries /prefix/${TREACLE_SITE_PACKAGES}/treacle /prefix/${CMAKE_INSTALL_LIBDIR})
    set_target_properties(treacle_python PROPERTIES INSTALL_RPATH "$ORIGIN/${libraries}")
  endif()
endif()
install(TARGETS treacle)
install(TARGETS treacle_library ${rooms} EXPORT treacleTargets FILE_SET HEADERS)
foreach(processor IN LISTS TREACLE_PROCESSORS)
  get_property(loops GLOBAL PROPERTY TREACLE_LOOPS_OF_${processor})
  if(NOT SKBUILD)
    set_target_properties(${loops} PROPERTIES INSTALL_RPATH "$ORIGIN/../..")
  endif()
  install(TARGETS ${loops} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/glibc-hwcaps/${processor})
endforeach()
install(EXPORT treacleTargets NAMESPACE treacle:: DESTINATION ${package_dir})
install(DIRECTORY cases DESTINATION ${CMAKE_INSTALL_DATADIR}/treacle FILES_MATCHING PATTERN *.toml PATTERN *.stl)
# For the commands that are Python: beside the program, which looks there.
install(DIRECTORY python/treacle DESTINATION ${CMAKE_INSTALL_DATADIR}/treacle/python PATTERN __pycache__ EXCLUDE)
file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/share/treacle)
file(CREATE_LINK ${CMAKE_SOURCE_DIR}/python ${CMAKE_BINARY_DIR}/share/treacle/python SYMBOLIC)

configure_package_config_file(cmake/treacleConfig.cmake.in ${CMAKE_BINARY_DIR}/treacleConfig.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/treacleConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/treacleConfig.cmake ${CMAKE_BINARY_DIR}/treacleConfigVersion.cmake
  DESTINATION ${package_dir})

# What the program says of itself: manual page, completion of commands in shells, schema of case files for editors.
set(texts ${CMAKE_BINARY_DIR}/texts)
set(made)
function(treacle_text FILE DESTINATION)
  add_custom_command(OUTPUT ${texts}/${FILE} DEPENDS treacle
    COMMAND ${CMAKE_COMMAND} -E make_directory ${texts} COMMAND treacle ${ARGN} > ${texts}/${FILE} VERBATIM)
  install(FILES ${texts}/${FILE} DESTINATION ${DESTINATION})
  set(made ${made} ${texts}/${FILE} PARENT_SCOPE)
endfunction()
treacle_text(treacle.1 ${CMAKE_INSTALL_MANDIR}/man1 man)
treacle_text(treacle ${CMAKE_INSTALL_DATADIR}/bash-completion/completions completion bash)
treacle_text(_treacle ${CMAKE_INSTALL_DATADIR}/zsh/site-functions completion zsh)
treacle_text(treacle.fish ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d completion fish)
treacle_text(case.schema.json ${CMAKE_INSTALL_DATADIR}/treacle schema)
add_custom_target(treacle_texts ALL DEPENDS ${made})
install(FILES LICENSE THIRD-PARTY-NOTICES.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
