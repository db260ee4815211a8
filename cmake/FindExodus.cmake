# Finds Exodus II, the format of Sandia's programs, as a library: Exodus::Exodus (BSD).

find_path(EXODUS_INCLUDE_DIR exodusII.h)
find_library(EXODUS_LIBRARY NAMES exodus exoIIv2c)
mark_as_advanced(EXODUS_INCLUDE_DIR EXODUS_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Exodus DEFAULT_MSG EXODUS_LIBRARY EXODUS_INCLUDE_DIR)

if(Exodus_FOUND)
  add_library(Exodus::Exodus UNKNOWN IMPORTED)
  set_target_properties(Exodus::Exodus PROPERTIES
    IMPORTED_LOCATION "${EXODUS_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${EXODUS_INCLUDE_DIR}")
endif()
