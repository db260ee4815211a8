# Finds TetGen as a library: TetGen::TetGen. A package's own CMake configuration is preferred; Debian's has none.
#
# TetGen is AGPL-3: whatever links this target is distributed under that licence.

find_package(TetGen CONFIG QUIET)
if(TARGET TetGen::TetGen)
  set(TetGen_FOUND TRUE)
  return()
endif()

# Configurations without a namespace: vcpkg's and conda's "tetgen", older ones' "tet".
foreach(target tetgen tet)
  if(TetGen_FOUND AND TARGET ${target})
    add_library(TetGen::TetGen INTERFACE IMPORTED)
    target_link_libraries(TetGen::TetGen INTERFACE ${target})
    set_target_properties(TetGen::TetGen PROPERTIES INTERFACE_COMPILE_DEFINITIONS TETLIBRARY)
    return()
  endif()
endforeach()

find_path(TetGen_INCLUDE_DIR tetgen.h)
find_library(TetGen_LIBRARY NAMES tet tetgen)
mark_as_advanced(TetGen_INCLUDE_DIR TetGen_LIBRARY)

if(TetGen_INCLUDE_DIR)
  file(STRINGS "${TetGen_INCLUDE_DIR}/tetgen.h" TetGen_version_line REGEX "// Version [0-9.]+" LIMIT_COUNT 1)
  string(REGEX MATCH "[0-9][0-9.]*" TetGen_VERSION "${TetGen_version_line}")
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(TetGen REQUIRED_VARS TetGen_LIBRARY TetGen_INCLUDE_DIR VERSION_VAR TetGen_VERSION)

if(TetGen_FOUND)
  add_library(TetGen::TetGen UNKNOWN IMPORTED)
  set_target_properties(TetGen::TetGen PROPERTIES
    IMPORTED_LOCATION "${TetGen_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${TetGen_INCLUDE_DIR}"
    INTERFACE_COMPILE_DEFINITIONS TETLIBRARY)
endif()
