# Finds MED, the format of Salome and Code_Aster, as a library: MED::MED (LGPL-3.0 or later). Its header includes HDF5's
# and MPI's, of which nothing is called.

find_path(MED_INCLUDE_DIR medfile.h)
find_path(MED_HDF5_INCLUDE_DIR hdf5.h PATH_SUFFIXES hdf5/openmpi hdf5/mpich hdf5/serial)
set(MPI_CXX_SKIP_MPICXX ON)
find_package(MPI QUIET COMPONENTS CXX)
find_library(MED_LIBRARY NAMES medC med)
mark_as_advanced(MED_INCLUDE_DIR MED_HDF5_INCLUDE_DIR MED_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(MED DEFAULT_MSG MED_LIBRARY MED_INCLUDE_DIR MED_HDF5_INCLUDE_DIR MPI_CXX_FOUND)

if(MED_FOUND)
  add_library(MED::MED UNKNOWN IMPORTED)
  set_target_properties(MED::MED PROPERTIES
    IMPORTED_LOCATION "${MED_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${MED_INCLUDE_DIR};${MED_HDF5_INCLUDE_DIR};${MPI_CXX_INCLUDE_DIRS}")
endif()
