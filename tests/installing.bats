# What bootstrap.sh installs, and what cmake --install and the packages bring.
# bats file_tags=optimized

load helpers

# A system without any of our packages: what apt-get is told to install lands in the file `installed`.
bare_system() {
  mkdir stubs
  printf '#!/bin/sh\nexit 1\n' >stubs/dpkg-query
  printf '#!/bin/sh\ncase "$*" in *calculix-ccx*) echo "  Candidate: (none)" ;; *) echo "  Candidate: 1.0" ;; esac\n' >stubs/apt-cache
  printf '#!/bin/sh\ncase "$*" in *install*) echo "$@" >>"%s/installed" ;; esac\n' "$PWD" >stubs/apt-get
  # As if we were another user: what sudo is told is done.
  printf '#!/bin/sh\nexec "$@"\n' >stubs/sudo
  chmod +x stubs/*
}

@test "bootstrap.sh installs what builds hexpipe; tests/run.sh asks for what tests need" {
  bare_system
  PATH="$PWD/stubs:$PATH" run "$HEXPIPE_SOURCE/bootstrap.sh" packages
  assert_success
  grep -qw cmake installed
  for package in bats gmsh chromium libgtest-dev python3-vtk9; do refute grep -qw "$package" installed; done
  rm installed
  PATH="$PWD/stubs:$PATH" run "$HEXPIPE_SOURCE/bootstrap.sh" compile-tests
  assert_success
  for package in cmake bats libgtest-dev; do grep -qw "$package" installed; done
  for package in gmsh chromium python3-vtk9; do refute grep -qw "$package" installed; done
  rm installed
  PATH="$PWD/stubs:$PATH" run "$HEXPIPE_SOURCE/bootstrap.sh" tests
  assert_success
  for package in cmake bats gmsh chromium libgtest-dev python3-vtk9; do grep -qw "$package" installed; done
  grep -q 'bootstrap.sh tests' "$HEXPIPE_SOURCE/tests/run.sh"
}

@test "bootstrap.sh goes on without a package of the tests that the release does not have" {
  bare_system
  PATH="$PWD/stubs:$PATH" run "$HEXPIPE_SOURCE/bootstrap.sh" tests
  assert_success
  assert_output --partial "this release has no package calculix-ccx"
  refute grep -qw calculix-ccx installed
  run -2 "$HEXPIPE_SOURCE/bootstrap.sh" package
  assert_output --partial "usage:"
}

@test "the Dockerfile builds by bootstrap.sh and installs the packages of cpack" {
  grep -q '^RUN ./bootstrap.sh && .*cpack' "$HEXPIPE_SOURCE/Dockerfile"
  grep -q '^COPY --from=build /hexpipe/build/\*.deb' "$HEXPIPE_SOURCE/Dockerfile"
}

@test "cpack stops where it would make packages without dependencies" {
  local cmake missing script="$HEXPIPE_SOURCE/cmake/DebianTools.cmake"
  cmake=$(command -v cmake)
  mkdir programs
  for missing in dpkg-shlibdeps file; do
    printf '#!/bin/sh\n' | tee programs/dpkg-shlibdeps >programs/file
    chmod +x programs/*
    PATH="$PWD/programs" "$cmake" -DCPACK_GENERATOR=DEB -P "$script"
    rm "programs/$missing"
    PATH="$PWD/programs" run "$cmake" -DCPACK_GENERATOR=DEB -P "$script"
    assert_failure
    assert_output --partial "dpkg-dev file"
    PATH="$PWD/programs" "$cmake" -DCPACK_GENERATOR=TGZ -P "$script"
  done
  grep -q "CPACK_PRE_BUILD_SCRIPTS.*/DebianTools.cmake" "$HEXPIPE_SOURCE/cmake/Packages.cmake"
}

# install COMPONENT: to the folder usr.
install() {
  cmake --install "$HEXPIPE_BIN/.." --component "$1" --prefix "$PWD/usr" >/dev/null
}

setup() {
  mkdir "$BATS_TEST_TMPDIR/work" && cd "$BATS_TEST_TMPDIR/work" || return 1
  [[ -e "$HEXPIPE_BIN/../cmake_install.cmake" || $BATS_TEST_NUMBER -le 4 ]] || skip "not in a directory of cmake"
}

@test "the installed Makefile.examples meshes the installed bracket" {
  [[ -x "$HEXPIPE_BIN/tetmesh" ]] || skip "tetmesh is not built"
  install hexpipe
  make -s -f usr/share/doc/hexpipe/Makefile.examples BIN="$HEXPIPE_BIN" SIZE=12 TIME=1 bracket.msh
  assert_conforming bracket.msh
  run make -s -n -f usr/share/doc/hexpipe/Makefile.examples BIN="$HEXPIPE_BIN" all
  assert_success
  run make -s -f usr/share/doc/hexpipe/Makefile.examples fuzz
  assert_failure
  assert_output --partial "needs the repository"
}

@test "man pages are installed gzipped, with the date of the version" {
  command -v help2man >/dev/null || skip "help2man is not there"
  install hexpipe
  local page date
  date=$(sed -n 's/^set(HEXPIPE_DATE \(.*\))$/\1/p' "$HEXPIPE_SOURCE/CMakeLists.txt")
  assert [ -n "$date" ]
  assert [ "$(ls usr/share/man/man1/*.1.gz | wc -l)" -ge 7 ]
  assert_equal "$(find usr/share/man -name '*.[15]')" ""
  for page in usr/share/man/man1/*.1.gz; do
    zcat "$page" | grep -q "^\.TH .*\"$(LC_ALL=C date -u -d "${SOURCE_DATE_EPOCH:+@}${SOURCE_DATE_EPOCH:-$date}" '+%B %Y')\""
  done
  zcat usr/share/man/man5/hexpipe-formats.5.gz | grep -q "^\.TH HEXPIPE.*\"$date\""
  # The time at which a page was packed would differ from build to build: bytes 4 to 7.
  assert_equal "$(head -c 8 usr/share/man/man1/hexpipe.1.gz | tail -c 4 | od -An -tx1 | tr -d ' ')" 00000000
}

@test "every package has a file copyright in Debian's format" {
  local component components="hexpipe"
  [[ ! -x "$HEXPIPE_BIN/wrap" ]] || components+=" hexpipe-wrap"
  [[ ! -e "$HEXPIPE_BIN/../lib/hexpipe" ]] || components+=" hexpipe-formats"
  [[ ! -x "$HEXPIPE_BIN/tetmesh" ]] || components+=" hexpipe-tetmesh"
  [[ ! -x "$HEXPIPE_BIN/tessellate" ]] || components+=" hexpipe-cad"
  [[ ! -x "$HEXPIPE_BIN/lns-mpi" ]] || components+=" hexpipe-mpi"
  for component in $components; do
    install $component
    grep -q '^Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/$' "usr/share/doc/$component/copyright"
    grep -q '^Copyright: 2' "usr/share/doc/$component/copyright"
    grep -q '^ Permission is hereby granted' "usr/share/doc/$component/copyright"
    grep -q 'GNU Affero General Public License' "usr/share/doc/$component/copyright"
    # A line of a paragraph begins with a blank, and an empty one is a full stop.
    run grep -nE '^ *$' "usr/share/doc/$component/copyright"
    assert_equal "${#lines[@]}" 2
  done
}

@test "a package says in its first line what it is, and depends on the programs that it starts" {
  command -v dpkg-shlibdeps >/dev/null && command -v file >/dev/null || skip "dpkg-dev or file is not there"
  [[ -x "$HEXPIPE_BIN/lns-mpi" ]] || skip "lns-mpi is not built"
  local work=$PWD package
  (cd "$HEXPIPE_BIN/.." && cpack -G DEB -B "$work/packages" -D CPACK_COMPONENTS_ALL=hexpipe-mpi >/dev/null)
  package=$(echo packages/hexpipe-mpi_*.deb)
  run dpkg-deb -f "$package" Description
  assert_line --index 0 "The search of hexpipe on many machines"
  # A line with a second blank would be shown as it is, not as text.
  assert_line --index 1 --regexp '^ [A-Z]'
  run dpkg-deb -f "$package" Depends
  assert_output --partial "openmpi-bin"
  assert_output --partial "libstdc++6"
}
