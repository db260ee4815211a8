# Files that were made to do harm: archives that lead out, that swell, that never end. SECURITY.md tells what they try.

load helpers

# bundle FILE EXPRESSION: a bundle with the members that a list of (name, bytes) in Python says.
bundle() {
  $PYTHON - "$1" "$2" <<'PYTHON'
import io, sys, tarfile
with tarfile.open(sys.argv[1], "w", format=tarfile.PAX_FORMAT) as archive:
    for name, data in eval(sys.argv[2]):
        member = tarfile.TarInfo(name)
        member.size = len(data)
        archive.addfile(member, io.BytesIO(data))
PYTHON
}

# refused PATTERN FILE: by a tool that reads bundles, with little memory and in a short time, and nothing is left.
refused() {
  echo old >out.tar
  assert_fails_with 1 "$1" timeout 200 findhex "$2" -o out.tar
  assert_equal "$(cat out.tar)" old
}

@test "names that lead out of the archive are refused" {
  for name in ../x /etc/passwd mesh/../../x ..; do
    bundle out.in.tar "[('$name', b'')]"
    refused "expected a relative member name without '..'" out.in.tar
  done
}

@test "names that would play tricks on a terminal, or that cannot be written again, are refused" {
  for name in 'mesh/two\nlines' 'notes/\x1b[2J' 'notes/\x7f'; do
    bundle out.in.tar "[('$name', b'')]"
    refused "^findhex: out.in.tar: expected a member name of at most 255 printable ASCII characters, found '[ -~]*\?[ -~]*'$" out.in.tar
  done
  bundle out.in.tar "[('n' * 300, b'')]"
  refused "printable ASCII characters, found 'n+\.*'" out.in.tar
  bundle out.in.tar "[('n' * 255, b'')]"
  refused "expected mesh for findhex" out.in.tar
}

@test "directories, FIFOs and devices are refused" {
  for kind in DIRTYPE FIFOTYPE CHRTYPE BLKTYPE LNKTYPE SYMTYPE; do
    $PYTHON -c "
import tarfile
with tarfile.open('$kind.tar', 'w', format=tarfile.PAX_FORMAT) as archive:
    member = tarfile.TarInfo('mesh/points.npy')
    member.type, member.linkname = tarfile.$kind, '/etc/passwd'
    archive.addfile(member)"
    refused "mesh/points.npy/?: expected a plain file" $kind.tar
  done
}

@test "a file with holes is refused: it could be of any size" {
  mkdir mesh
  truncate -s 1G mesh/points.npy
  for format in gnu posix; do
    tar --format=$format -cSf holes.in.tar mesh/points.npy
    refused "expected a plain file in the bundle, found one with holes" holes.in.tar
  done
}

@test "a compressed bundle that swells beyond reason is refused before it fills anything" {
  bundle swelling.tar "[('notes/zeros', bytes(300 << 20))]"
  zstd -q -19 swelling.tar
  rm swelling.tar
  refused "expected a bundle that is compressed by less than 1000 to 1" swelling.tar.zst
}

@test "zeros that a pipeline may hold are none of that" {
  $PYTHON "$DATA/lattices/lattice.py" kuhn 2 | findhex -o part.tar.zst
  $PYTHON - <<'PYTHON'
import io, numpy, subprocess, tarfile
with tarfile.open("zeros.tar", "w", format=tarfile.PAX_FORMAT) as archive:
    for name, data in (("notes/random", numpy.random.default_rng(1).bytes(1 << 20)), ("notes/zeros", bytes(300 << 20))):
        member = tarfile.TarInfo(name)
        member.size = len(data)
        archive.addfile(member, io.BytesIO(data))
    whole = tarfile.open(fileobj=io.BytesIO(subprocess.run(["zstd", "-dc", "part.tar.zst"], stdout=subprocess.PIPE).stdout))
    for member in whole:
        archive.addfile(member, whole.extractfile(member))
PYTHON
  zstd -q zeros.tar
  buildgraph zeros.tar.zst -o part.graph
}

@test "more members than a bundle has are refused" {
  bundle many.tar "[('notes/%d' % i, b'') for i in range(10001)]"
  refused "expected a bundle of at most 10000 members, found more" many.tar
}

@test "history that is no object, too long or too deep is refused" {
  bundle list.tar "[('history/01-x.json', b'[1]')]"
  refused "history/01-x.json: expected a JSON object" list.tar
  bundle number.tar "[('history/01-x.json', b'{\"tool\": 1}')]"
  refused "history/01-x.json: expected a JSON object" number.tar
  bundle version.tar "[('history/01-x.json', b'{\"tool\": \"x\", \"version\": 1}')]"
  refused "history/01-x.json: expected a version that is text" version.tar
  bundle options.tar "[('history/01-x.json', b'{\"tool\": \"x\", \"options\": [1]}')]"
  refused "history/01-x.json: expected options as a JSON object" options.tar
  bundle long.tar "[('history/01-x.json', b'[' * (2 << 20))]"
  refused "history/01-x.json: expected at most 1048576 bytes" long.tar
  bundle deep.tar "[('history/01-x.json', b'[' * 1000000 + b']' * 1000)]"
  refused "history/01-x.json: expected a JSON object" deep.tar
  bundle levels.tar "[('history/01-x.json', b'{\"a\":' + b'[' * 64 + b']' * 64 + b'}')]"
  refused "history/01-x.json: expected a JSON object of at most 64 levels, found more" levels.tar
  bundle brackets.tar "[('history/01-x.json', b'{\"a\": \"\\\\\"' + b'[' * 100 + b'\"}')]"
  refused "expected mesh for findhex" brackets.tar
}

# Well-formed, and with a mesh: the tools that copy and write entries go through all of their levels.
@test "history of many levels ends no tool by a signal" {
  $PYTHON "$DATA/lattices/lattice.py" kuhn 2 | findhex | buildgraph -o part.tar
  $PYTHON - <<'PYTHON'
import io, tarfile
with tarfile.open("part.tar") as part, tarfile.open("deep.tar", "w", format=tarfile.PAX_FORMAT) as deep:
    for member in part:
        deep.addfile(member, part.extractfile(member))
    for where in ("a", "options"):
        value = b"[" * 400000 + b"]" * 400000
        entry = b'{"tool":"x","%s":%s}' % (where.encode(), value if where == "a" else b'{"b":%s}' % value)
        member = tarfile.TarInfo(f"history/09-{where}.json")
        member.size = len(entry)
        deep.addfile(member, io.BytesIO(entry))
PYTHON
  local message="deep.tar: history/09-a.json: expected a JSON object of at most 64 levels, found more"
  assert_fails_with 1 "$message" mesh-part deep.tar --parts 2 -o parts
  assert_fails_with 1 "$message" initsol deep.tar -o out.tar
  if [[ -x "$HEXPIPE_BIN/viewmesh" ]]; then assert_fails_with 1 "$message" viewmesh deep.tar -o out.html; fi
}

@test "a name of a tool that would lead out of the history is refused" {
  for name in ../../evil a/b Evil 'e vil' '' "$(printf 'x%.0s' {1..65})"; do
    bundle out.in.tar "[('history/01-x.json', b'{\"tool\": \"$name\"}')]"
    refused "history/01-x.json: expected a tool named by 1 to 64 of a to z, 0 to 9 and '-', found " out.in.tar
  done
  # merge-parts makes it part of a member's name.
  $PYTHON "$DATA/lattices/lattice.py" kuhn 2 | mesh-part --parts 2 -o parts
  for part in parts/*.tar; do
    findhex "$part" -o candidates.tar
    $PYTHON - "$(basename "$part")" <<'PYTHON'
import io, sys, tarfile
with tarfile.open("candidates.tar") as part, tarfile.open(sys.argv[1], "w", format=tarfile.PAX_FORMAT) as evil:
    for member in part:
        data = part.extractfile(member).read()
        if member.name == "history/02-findhex.json":
            data = b'{"tool": "../../evil"}'
            member.size = len(data)
        evil.addfile(member, io.BytesIO(data))
PYTHON
  done
  assert_fails_with 1 "expected a tool named by .*, found '../../evil'" merge-parts part-*.tar -o out.tar
  bundle good.tar "[('history/01-x.json', b'{\"tool\": \"$(printf 'x%.0s' {1..62})-7\"}')]"
  refused "expected mesh for findhex" good.tar
}

# The sanitizers reserve more.
# bats test_tags=optimized
@test "counts that no file of this length can hold are refused without memory for them" {
  local limit='ulimit -v 1500000; exec timeout 120 "$@"'
  printf 'MeshVersionFormatted 2\nDimension 3\nVertices\n4000000000\n0 0 0 0\n' >many.mesh
  printf '# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4000000000 double\n0 0 0\n' >many.vtk
  printf '$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4000000000\n1 0 0 0\n' >many.msh
  printf '4000000000 3 0 0\n1 0 0 0\n' >many.node
  for file in many.mesh many.vtk many.msh many.node; do
    assert_fails_with 1 "$file(:[0-9]+)?: expected" bash -c "$limit" limit findhex --mesh $file -o out.tar
  done
  echo 'hexpipe-candidates 1 4000000000 1 1' >many.cand
  assert_fails_with 1 "many.cand:1: expected" bash -c "$limit" limit buildgraph --candidates many.cand -o out.tar
  echo '4000000000 1 10' >many.graph
  assert_fails_with 1 "many.graph:1: expected" bash -c "$limit" limit initsol --graph many.graph -o out.tar
  echo '2147483648 0' >beyond.graph
  assert_fails_with 1 "beyond.graph:1: expected fewer than 2\^31 vertices" bash -c "$limit" limit initsol --graph beyond.graph -o out.tar
}

@test "what a terminal would obey in the name of a file or in its bytes stays out of messages" {
  local name=$'new\nline \e[31m.mesh'
  printf 'MeshVersionFormatted 2\nDimension 3\nVertices\nmany\n' >"$name"
  assert_fails_with 1 "^findhex: new\?line \?\[31m.mesh:4: expected .*, found 'many'$" findhex --mesh "$name" -o out.tar
  # U+009B is a control character too, U+00FC is not.
  cp "$name" $'\xc2\x9b31m\xc3\xbc.mesh'
  assert_fails_with 1 $'^findhex: \\?31m\xc3\xbc.mesh:4: expected' findhex --mesh $'\xc2\x9b31m\xc3\xbc.mesh' -o out.tar
  $PYTHON -c "
import io, numpy
out = io.BytesIO(); numpy.save(out, numpy.zeros((4, 3)))
open('points.npy', 'wb').write(out.getvalue().replace(b'<f8', b'<\n8'))"
  tar --format=pax -cf type.tar --transform 's,^,mesh/,' points.npy
  refused "mesh/points.npy: expected little-endian numbers .*, found type '<\?8'" type.tar
}

@test "a surface that is a million times longer than wide ends in an error, not in points without end" {
  [[ -x "$HEXPIPE_BIN/tetmesh" ]] || skip "tetmesh is not built"
  tail -c +2 "$HEXPIPE_SOURCE/tests/fuzz/findings/surface/front-leaves-a-sliver" >sliver.off
  assert_fails_with 1 "^tetmesh: sliver.off: TetGen failed: it moved or merged points of the surface$" timeout 200 tetmesh sliver.off --size 25% -o out.tar
  assert [ ! -e out.tar ]
}
