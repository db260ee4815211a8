#!/usr/bin/env bash
# Installs what hexpipe needs on Debian 12 or 13, builds it, and meshes a real part.
#
#   ./bootstrap.sh                 everything
#   ./bootstrap.sh packages        only the packages that build hexpipe
#   ./bootstrap.sh compile-tests   only these packages and those that compile its tests
#   ./bootstrap.sh tests           only these packages and those that run the tests; tests/run.sh asks for them
set -euo pipefail
cd "$(dirname "$0")"

build_packages=(
  cmake ninja-build make g++ ca-certificates
  libcli11-dev libfmt-dev nlohmann-json3-dev robin-map-dev libtbb-dev libboost-dev
  libarchive-dev libzstd-dev libpugixml-dev zlib1g-dev
  libopenmesh-dev libtet1.5-dev libcgal-dev libeigen3-dev libgmp-dev libmpfr-dev coinor-libclp-dev
  libmetis-dev libopenmpi-dev openmpi-bin
  libocct-data-exchange-dev libocct-modeling-algorithms-dev libfontconfig-dev
  libexodusii-dev libmedc-dev libcgns-dev
  esbuild libjs-three libosmesa6-dev libpng-dev libfreetype-dev fonts-dejavu-core help2man
)
compile_test_packages=(bats libgtest-dev libgmock-dev libbenchmark-dev)
test_packages=(
  "${compile_test_packages[@]}" bats-assert bats-support
  python3 python3-numpy python3-meshio python3-vtk9 gmsh coinor-cbc zstd procps
  python3-getfem calculix-ccx python3-scipy python3-matplotlib
  netcdf-bin python3-netcdf4 python3-h5py libmed-tools cgns-convert
  chromium chromium-driver python3-selenium gnuplot-nox man-db dpkg-dev file
)
# Compiles the tests under sanitizers. Debian 13 has no clang 16; with clang 19 the CGAL of Debian 12 does not compile.
clang_packages() {
  echo "clang-$1" "libclang-rt-$1-dev" "lld-$1" "llvm-$1"
}

is_installed() {
  dpkg-query -W -f='${Status}' "$1" 2>/dev/null | grep -q 'ok installed'
}

# A release of Debian may lack a program that only tests use. The tests that need it are skipped.
is_offered() {
  [[ $(apt-cache policy "$1") == *"Candidate: "[^\(]* ]]
}

# install_packages PACKAGES...: those that are missing.
install_packages() {
  local missing=() offered=() package
  for package in "$@"; do is_installed "$package" || missing+=("$package"); done
  if ((${#missing[@]} == 0)); then return; fi
  local as_root=()
  if ((EUID != 0)); then as_root=(sudo); fi
  "${as_root[@]}" apt-get update -q
  for package in "${missing[@]}"; do
    if [[ " ${build_packages[*]} " == *" $package "* ]] || is_offered "$package"; then
      offered+=("$package")
    else
      echo "bootstrap.sh: this release has no package $package; tests that need it are skipped" >&2
    fi
  done
  if ((${#offered[@]} == 0)); then return; fi
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${offered[@]}"
}

case "${1:-}" in
  "") install_packages "${build_packages[@]}" ;;
  packages)
    install_packages "${build_packages[@]}"
    exit
    ;;
  compile-tests)
    install_packages "${build_packages[@]}" "${compile_test_packages[@]}"
    exit
    ;;
  tests)
    clang=19
    if grep -q '^VERSION_ID="12"' /etc/os-release; then clang=16; fi
    # shellcheck disable=SC2046
    install_packages "${build_packages[@]}" "${test_packages[@]}" $(clang_packages "$clang")
    exit
    ;;
  *)
    echo "usage: ./bootstrap.sh [packages|tests|compile-tests]" >&2
    exit 2
    ;;
esac

cmake --preset release -DHEXPIPE_TESTS=OFF
cmake --build --preset release
make -f Makefile.examples bracket.vtu bracket.msh
echo "Open bracket.vtu in ParaView, or bracket.msh in Gmsh. The tools are in build/bin."
