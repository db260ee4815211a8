# `cpack` in the build directory makes Debian packages: hexpipe (MIT), and apart from it hexpipe-tetmesh (AGPL),
# hexpipe-cad (MIT, needs OpenCASCADE), hexpipe-formats (MIT, needs NetCDF, MED and CGNS), hexpipe-wrap (GPL) and
# hexpipe-mpi (MIT, needs MPI). hexpipe recommends tetmesh, without which it meshes no surface, and only suggests the others.
# Included last, when every component is known. What they depend on is found from the executables, by dpkg-shlibdeps.

# Whoever makes a package answers for it: the variables are those of Debian's own tools.
set(maintainer "The hexpipe developers")
if(DEFINED ENV{DEBFULLNAME} AND DEFINED ENV{DEBEMAIL})
  set(maintainer "$ENV{DEBFULLNAME} <$ENV{DEBEMAIL}>")
endif()
set(HEXPIPE_MAINTAINER "${maintainer}" CACHE STRING "Who answers for packages, as Name <address>; else DEBFULLNAME, DEBEMAIL")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME hexpipe)
set(CPACK_PACKAGE_VENDOR "The hexpipe developers")
set(CPACK_PACKAGE_CONTACT "${HEXPIPE_MAINTAINER}")
# A package's summary is the first line of its description. One for all of them would stand before it.
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")
set(CPACK_RESOURCE_FILE_LICENSE "${PROJECT_SOURCE_DIR}/LICENSE")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PRE_BUILD_SCRIPTS "${PROJECT_SOURCE_DIR}/cmake/DebianTools.cmake" "${PROJECT_SOURCE_DIR}/cmake/DebianFolders.cmake")
set(CPACK_COMPONENTS_ALL hexpipe)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEB_COMPONENT_INSTALL ON)

set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_HEXPIPE_PACKAGE_NAME hexpipe)
set(CPACK_COMPONENT_HEXPIPE_DESCRIPTION
"Conforming hex-dominant meshes out of tetrahedra
A pipeline of small tools that finds every way to merge tetrahedra into
hexahedra, chooses the best set of them that fit together as a maximum weight
independent set, and builds a conforming mesh for finite elements.")
set(CPACK_DEBIAN_HEXPIPE_PACKAGE_RECOMMENDS hexpipe-tetmesh)
set(CPACK_DEBIAN_HEXPIPE_PACKAGE_SUGGESTS "hexpipe-cad, hexpipe-wrap, hexpipe-formats, hexpipe-mpi")

if(WITH_OCCT)
  list(APPEND CPACK_COMPONENTS_ALL hexpipe-cad)
  set(CPACK_DEBIAN_HEXPIPE-CAD_PACKAGE_NAME hexpipe-cad)
  set(CPACK_COMPONENT_HEXPIPE-CAD_DESCRIPTION
"CAD files for hexpipe
Makes triangles of STEP, IGES and BREP by OpenCASCADE, with curves, bodies and
names, for tetmesh and for other mesh generators.")
  set(CPACK_DEBIAN_HEXPIPE-CAD_PACKAGE_RECOMMENDS hexpipe)
endif()

if(WITH_WRAP)
  list(APPEND CPACK_COMPONENTS_ALL hexpipe-wrap)
  set(CPACK_DEBIAN_HEXPIPE-WRAP_PACKAGE_NAME hexpipe-wrap)
  set(CPACK_COMPONENT_HEXPIPE-WRAP_DESCRIPTION
"Closed surfaces for hexpipe out of any triangles
Wraps a closed surface around triangles that are open, cross each other or
belong together in no way. It links CGAL and so is under the GPL, version 3.")
  set(CPACK_DEBIAN_HEXPIPE-WRAP_PACKAGE_RECOMMENDS hexpipe)
endif()

if(WITH_EXODUS OR WITH_MED OR WITH_CGNS)
  list(APPEND CPACK_COMPONENTS_ALL hexpipe-formats)
  set(CPACK_DEBIAN_HEXPIPE-FORMATS_PACKAGE_NAME hexpipe-formats)
  set(CPACK_COMPONENT_HEXPIPE-FORMATS_DESCRIPTION
"Exodus II, MED and CGNS for hexpipe
Modules that the tools load to read and write meshes of these formats.")
  set(CPACK_DEBIAN_HEXPIPE-FORMATS_PACKAGE_RECOMMENDS hexpipe)
endif()

if(WITH_TETGEN)
  list(APPEND CPACK_COMPONENTS_ALL hexpipe-tetmesh)
  set(CPACK_DEBIAN_HEXPIPE-TETMESH_PACKAGE_NAME hexpipe-tetmesh)
  set(CPACK_COMPONENT_HEXPIPE-TETMESH_DESCRIPTION
"Tetrahedra for hexpipe out of a closed surface
Fills a surface (STL, OBJ, PLY, OFF) with tetrahedra whose vertices lie so that
they merge into hexahedra. It links TetGen and so is under the AGPL, version 3.")
  set(CPACK_DEBIAN_HEXPIPE-TETMESH_PACKAGE_RECOMMENDS hexpipe)
endif()

if(TARGET lns-mpi)
  list(APPEND CPACK_COMPONENTS_ALL hexpipe-mpi)
  set(CPACK_DEBIAN_HEXPIPE-MPI_PACKAGE_NAME hexpipe-mpi)
  set(CPACK_COMPONENT_HEXPIPE-MPI_DESCRIPTION
"The search of hexpipe on many machines
Improves a choice of candidates by large neighbourhood search over MPI, on a graph
that may be too large for one machine.")
  # Open MPI starts a program of openmpi-bin even for one process, which no library tells.
  set(CPACK_DEBIAN_HEXPIPE-MPI_PACKAGE_DEPENDS openmpi-bin)
  set(CPACK_DEBIAN_HEXPIPE-MPI_PACKAGE_RECOMMENDS hexpipe)
endif()
include(CPack)
