# Static libraries make each program complete by itself. Shared ones (TREACLE_SHARED) are for several programs that
# travel together: kernels then lie in one place, and all share one CUDA runtime.
if(TREACLE_SHARED)
  set(TREACLE_LIBRARY_KIND SHARED)
  set(TREACLE_CUDA_RUNTIME CUDA::cudart)
  set(CMAKE_CUDA_RUNTIME_LIBRARY Shared)
else()
  set(TREACLE_LIBRARY_KIND STATIC)
  set(TREACLE_CUDA_RUNTIME CUDA::cudart_static)
endif()

# Compressed kernels take a third of the space, and about as long to load.
set(TREACLE_CUDA_OPTIONS --expt-relaxed-constexpr --extended-lambda -Xcompiler=-Wall,-Wextra)  # std::span and loop bodies in device code
if(CUDAToolkit_VERSION VERSION_GREATER_EQUAL 12.8)
  list(APPEND TREACLE_CUDA_OPTIONS --compress-mode=size)
endif()

# treacle_room(NAME SOURCES a.cpp ... DEPENDS core ... PRIVATE lib ...): library treacle_NAME, alias treacle::NAME. The
# headers of a room are in include/NAME, which only rooms that depend on it see.
function(treacle_room NAME)
  cmake_parse_arguments(ROOM "" "" "SOURCES;DEPENDS;PRIVATE" ${ARGN})
  set(loops ${ROOM_SOURCES})
  list(FILTER loops INCLUDE REGEX "_cpu\\.cpp$")
  list(FILTER ROOM_SOURCES EXCLUDE REGEX "_cpu\\.cpp$")
  if(loops)
    treacle_loops(${NAME})
  endif()
  treacle_library(treacle_${NAME} ${TREACLE_LIBRARY_KIND} ${ROOM_SOURCES})
  add_library(treacle::${NAME} ALIAS treacle_${NAME})
  set_target_properties(treacle_${NAME} PROPERTIES EXPORT_NAME ${NAME})
  set_property(GLOBAL APPEND PROPERTY TREACLE_ROOMS treacle_${NAME})
  treacle_headers(${NAME})
  if(loops AND TREACLE_PROCESSORS)
    target_link_libraries(treacle_${NAME} PUBLIC treacle_${NAME}_loops)
  elseif(loops)
    target_sources(treacle_${NAME} PRIVATE $<TARGET_OBJECTS:treacle_${NAME}_loops>)
  endif()
endfunction()

# Declares the headers of a room, so that the target all_verify_interface_header_sets compiles each of them alone.
function(treacle_headers NAME)
  file(GLOB_RECURSE headers CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/include/${NAME}/*.hpp)
  target_sources(treacle_${NAME} PUBLIC FILE_SET HEADERS BASE_DIRS ${CMAKE_SOURCE_DIR}/include/${NAME} FILES ${headers})
endfunction()

# The loops of a room, *_cpu.cpp, apart from its other sources. With TREACLE_PROCESSORS they are a library of their own:
# one for the lowest processor, and one for each of TREACLE_PROCESSORS in a directory of its name, where the dynamic
# loader looks first on a machine that has it (ld.so(8), "glibc-hwcaps"). They call what is in the room's other library,
# which loads them.
macro(treacle_loops NAME)
  if(NOT TREACLE_PROCESSORS)
    treacle_library(treacle_${NAME}_loops OBJECT ${loops})
  else()
    treacle_library(treacle_${NAME}_loops SHARED ${loops})
    set_target_properties(treacle_${NAME}_loops PROPERTIES EXPORT_NAME ${NAME}_loops)
    set_property(GLOBAL APPEND PROPERTY TREACLE_ROOMS treacle_${NAME}_loops)
  endif()
  treacle_loop_options(treacle_${NAME}_loops)
  foreach(processor IN LISTS TREACLE_PROCESSORS)
    set(target treacle_${NAME}_loops_${processor})
    treacle_library(${target} SHARED ${loops})
    treacle_loop_options(${target})
    target_compile_options(${target} PRIVATE -march=${processor})
    set_target_properties(${target} PROPERTIES OUTPUT_NAME treacle_${NAME}_loops
      LIBRARY_OUTPUT_DIRECTORY ${CMAKE_LIBRARY_OUTPUT_DIRECTORY}/glibc-hwcaps/${processor})
    set_property(GLOBAL APPEND PROPERTY TREACLE_LOOPS_OF_${processor} ${target})
    add_dependencies(treacle_${NAME}_loops ${target})
  endforeach()
endmacro()

function(treacle_loop_options TARGET)
  # g++ 12 warns about its own AVX-512 header, which they include.
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(${TARGET} PRIVATE -Wno-uninitialized -Wno-maybe-uninitialized)
  endif()
endfunction()

# A library of a room; takes the room's arguments.
macro(treacle_library TARGET)
  add_library(${TARGET} ${ARGN})
  set_target_properties(${TARGET} PROPERTIES POSITION_INDEPENDENT_CODE ON DEFINE_SYMBOL "")
  target_include_directories(${TARGET} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR} PUBLIC
    $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}/include/${NAME}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(${TARGET} PUBLIC cxx_std_20)
  foreach(dependency IN LISTS ROOM_DEPENDS)
    target_link_libraries(${TARGET} PUBLIC treacle_${dependency})
  endforeach()
  target_link_libraries(${TARGET} PRIVATE ${ROOM_PRIVATE})
  treacle_compile_options(${TARGET})
endmacro()

# treacle_kernels(NAME SOURCES foo.cu ... LARGE bar.cu ... PRIVATE lib ...): adds CUDA sources to the library of a room.
# SOURCES compile together, in a batch that is written here (CMake's own batches have no CUDA before 3.31, and are the
# same for all versions only if they have none); LARGE ones compile alone, so that several cores share them. One call of a
# room may have several SOURCES.
function(treacle_kernels NAME)
  cmake_parse_arguments(KERNELS "" "" "SOURCES;LARGE;PRIVATE" ${ARGN})
  list(LENGTH KERNELS_SOURCES count)
  if(CMAKE_UNITY_BUILD AND count GREATER 1)
    list(TRANSFORM KERNELS_SOURCES REPLACE "(.+)" "#include \"${CMAKE_CURRENT_SOURCE_DIR}/\\1\"")
    list(JOIN KERNELS_SOURCES "\n" text)
    set(KERNELS_SOURCES ${CMAKE_CURRENT_BINARY_DIR}/${NAME}_batch.cu)
    file(CONFIGURE OUTPUT ${KERNELS_SOURCES} CONTENT "${text}\n" @ONLY)
  endif()
  target_sources(treacle_${NAME} PRIVATE ${KERNELS_SOURCES} ${KERNELS_LARGE})
  set_source_files_properties(${KERNELS_SOURCES} ${KERNELS_LARGE} TARGET_DIRECTORY treacle_${NAME}
    PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  target_include_directories(treacle_${NAME} PRIVATE ${CMAKE_SOURCE_DIR}/kernels)
  target_link_libraries(treacle_${NAME} PRIVATE ${TREACLE_CUDA_RUNTIME} ${KERNELS_PRIVATE})
endfunction()

function(treacle_compile_options TARGET)
  # No -ffast-math: sums keep their order. The two flags only free sqrt from errno and traps, which lets it vectorise.
  target_compile_options(${TARGET} PRIVATE
    $<$<COMPILE_LANGUAGE:CXX>:-Wall -Wextra -Wshadow -fno-math-errno -fno-trapping-math>
    $<$<COMPILE_LANGUAGE:CXX>:${TREACLE_PROCESSOR_OPTIONS}>
    $<$<COMPILE_LANGUAGE:CXX>:-Wno-psabi>  # vectors may be wider than registers, and never leave one build
    $<$<AND:$<CXX_COMPILER_ID:GNU>,$<COMPILE_LANGUAGE:CXX>>:-Wno-maybe-uninitialized>  # wrong about optionals in optionals (GCC bug 80635)
    $<$<AND:$<CXX_COMPILER_ID:GNU>,$<COMPILE_LANGUAGE:CXX>,$<BOOL:${CMAKE_UNITY_BUILD}>>:-Wno-subobject-linkage>  # takes a batch's sources for headers
    $<$<AND:$<COMPILE_LANGUAGE:CXX>,$<BOOL:${TREACLE_WERROR}>>:-Werror>
    $<$<COMPILE_LANGUAGE:CUDA>:${TREACLE_CUDA_OPTIONS}>
    $<$<AND:$<COMPILE_LANGUAGE:CUDA>,$<BOOL:${TREACLE_WERROR}>>:-Werror all-warnings>)
endfunction()
