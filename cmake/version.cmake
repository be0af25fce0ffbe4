# The commit is read at build time (not at configure time, which may be long ago) into version.cpp.
find_package(Git QUIET)
set(TREACLE_VERSION_CPP ${CMAKE_BINARY_DIR}/generated/version.cpp)
set(mpi OFF)
if(TREACLE_MPI)
  set(mpi ON)
endif()
string(REPLACE ";" " " architectures "${CMAKE_CUDA_ARCHITECTURES}")
add_custom_target(treacle_version
  BYPRODUCTS ${TREACLE_VERSION_CPP}
  COMMAND ${CMAKE_COMMAND}
    -DSOURCE=${CMAKE_SOURCE_DIR} -DOUTPUT=${TREACLE_VERSION_CPP} -DGIT=${GIT_EXECUTABLE}
    -DVERSION=${PROJECT_VERSION} -DBUILD_TYPE=${CMAKE_BUILD_TYPE} -DNATIVE=${TREACLE_NATIVE} -DCUDA=${TREACLE_CUDA} -DMPI=${mpi}
    "-DARCHITECTURES=${architectures}"
    "-DCOMPILER=${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}"
    -P ${CMAKE_SOURCE_DIR}/cmake/write_version.cmake
  COMMENT "Reading the commit")
