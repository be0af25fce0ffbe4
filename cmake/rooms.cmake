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

# treacle_room(NAME SOURCES a.cpp ... DEPENDS core ... PRIVATE lib ...): library treacle_NAME, alias treacle::NAME.
function(treacle_room NAME)
  cmake_parse_arguments(ROOM "" "" "SOURCES;DEPENDS;PRIVATE" ${ARGN})
  add_library(treacle_${NAME} ${TREACLE_LIBRARY_KIND} ${ROOM_SOURCES})
  add_library(treacle::${NAME} ALIAS treacle_${NAME})
  set_target_properties(treacle_${NAME} PROPERTIES EXPORT_NAME ${NAME} POSITION_INDEPENDENT_CODE ON DEFINE_SYMBOL "")
  target_include_directories(treacle_${NAME} PUBLIC
    $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(treacle_${NAME} PUBLIC cxx_std_20)
  foreach(dependency IN LISTS ROOM_DEPENDS)
    target_link_libraries(treacle_${NAME} PUBLIC treacle_${dependency})
  endforeach()
  target_link_libraries(treacle_${NAME} PRIVATE ${ROOM_PRIVATE})
  treacle_compile_options(treacle_${NAME})
  set_property(GLOBAL APPEND PROPERTY TREACLE_ROOMS treacle_${NAME})
endfunction()

# treacle_kernels(NAME SOURCES foo.cu ... PRIVATE lib ...): adds CUDA sources to the library of a room.
function(treacle_kernels NAME)
  cmake_parse_arguments(KERNELS "" "" "SOURCES;PRIVATE" ${ARGN})
  target_sources(treacle_${NAME} PRIVATE ${KERNELS_SOURCES})
  target_include_directories(treacle_${NAME} PRIVATE ${CMAKE_SOURCE_DIR}/kernels)
  target_link_libraries(treacle_${NAME} PRIVATE ${TREACLE_CUDA_RUNTIME} ${KERNELS_PRIVATE})
endfunction()

function(treacle_compile_options TARGET)
  # No -ffast-math: sums keep their order. The two flags only free sqrt from errno and traps, which lets it vectorise.
  target_compile_options(${TARGET} PRIVATE
    $<$<COMPILE_LANGUAGE:CXX>:-Wall -Wextra -Wshadow -fno-math-errno -fno-trapping-math>
    $<$<COMPILE_LANGUAGE:CXX>:${TREACLE_NATIVE_OPTIONS}>
    $<$<COMPILE_LANGUAGE:CXX>:-Wno-psabi>  # Lanes are wider than many a processor's registers, and never leave one build
    $<$<AND:$<COMPILE_LANGUAGE:CXX>,$<BOOL:${TREACLE_WERROR}>>:-Werror>
    $<$<COMPILE_LANGUAGE:CUDA>:--expt-relaxed-constexpr --extended-lambda -Xcompiler=-Wall,-Wextra>  # std::span and loop bodies in device code
    $<$<AND:$<COMPILE_LANGUAGE:CUDA>,$<BOOL:${TREACLE_WERROR}>>:-Werror all-warnings>)
endfunction()
