#!/usr/bin/env bash
# Installs what hexpipe needs on Debian 12, builds it, and meshes a real part.
#
#   ./bootstrap.sh            everything
#   ./bootstrap.sh packages   only the packages
set -euo pipefail
cd "$(dirname "$0")"

build_packages=(
  cmake ninja-build make g++ ca-certificates
  libcli11-dev libfmt-dev nlohmann-json3-dev robin-map-dev libtbb-dev libboost-dev
  libarchive-dev libzstd-dev libpugixml-dev zlib1g-dev
  libopenmesh-dev libtet1.5-dev libcgal-dev libeigen3-dev libgmp-dev libmpfr-dev coinor-libclp-dev
  libmetis-dev libopenmpi-dev openmpi-bin
  libocct-data-exchange-dev libocct-modeling-algorithms-dev
  libexodusii-dev libmedc-dev libcgns-dev
  esbuild libjs-three libosmesa6-dev libpng-dev help2man
)
test_packages=(
  bats bats-assert bats-support libgtest-dev libgmock-dev libbenchmark-dev
  python3 python3-numpy python3-meshio python3-vtk9 gmsh coinor-cbc zstd procps
  python3-getfem calculix-ccx python3-scipy
  netcdf-bin python3-netcdf4 python3-h5py libmed-tools cgns-convert
  chromium chromium-driver python3-selenium gnuplot-nox man-db
)

install_packages() {
  local missing=() package
  for package in "${build_packages[@]}" "${test_packages[@]}"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
  done
  if ((${#missing[@]} == 0)); then return; fi
  local as_root=()
  if ((EUID != 0)); then as_root=(sudo); fi
  "${as_root[@]}" apt-get update -q
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}"
}

install_packages
if [[ "${1:-}" == packages ]]; then exit; fi

cmake --preset release -DHEXPIPE_TESTS=OFF
cmake --build --preset release
make -f Makefile.examples bracket.vtu
echo "bracket.vtu is ready: open it in ParaView, Gmsh or anything that reads VTU."
