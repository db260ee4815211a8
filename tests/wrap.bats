# wrap: a closed surface around triangles of any kind.
# bats file_tags=both

load helpers

# surface OFF: "closed-edges volume area-of-box" of an STL that wrap wrote, by a program of its own.
facts() {
  "$PYTHON" - "$1" <<'PYTHON'
import collections, sys
import numpy as np
corners = np.array([[float(x) for x in line.split()[1:]] for line in open(sys.argv[1]) if line.startswith("vertex")])
points, number = np.unique(corners, axis=0, return_inverse=True)
triangles = number.reshape(-1, 3)
edges = collections.Counter((t[i], t[(i + 1) % 3]) for t in triangles for i in range(3))
closed = all(count == 1 and edges[(b, a)] == 1 for (a, b), count in edges.items())
p = points[triangles]
volume = np.linalg.det(p).sum() / 6
# 0.0 is added because -0.0 is printed otherwise.
print(closed, round(float(volume), 3), *(np.round(points.min(axis=0), 3) + 0.0), *(np.round(points.max(axis=0), 3) + 0.0))
PYTHON
}

setup() {
  cd "$BATS_TEST_TMPDIR" || return 1
}

# The unit cube with a round-about hole of a few triangles, and a second one across it.
cubes() {
  "$PYTHON" - "$@" <<'PYTHON'
import sys
def cube(at, size, left_out=()):
    corner = [(at[0] + size * (i & 1), at[1] + size * (i >> 1 & 1), at[2] + size * (i >> 2)) for i in range(8)]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    for k, (a, b, c, d) in enumerate(quads):
        for m, t in enumerate(((a, b, c), (a, c, d))):
            if (k, m) not in left_out:
                yield [corner[v] for v in t]
kind = sys.argv[1]
triangles = {"whole": lambda: list(cube((0, 0, 0), 1)), "open": lambda: list(cube((0, 0, 0), 1, {(1, 0)})),
             "turned": lambda: [t[::-1] if i % 3 else t for i, t in enumerate(cube((0, 0, 0), 1))],
             "overlapping": lambda: list(cube((0, 0, 0), 1)) + list(cube((0.5, 0.5, 0.5), 1)),
             "inner": lambda: list(cube((0, 0, 0), 1)) + list(cube((0.3, 0.3, 0.3), 0.4))}[kind]()
print(f"OFF\n{3 * len(triangles)} {len(triangles)} 0")
for t in triangles:
    for p in t:
        print(*p)
for i in range(len(triangles)):
    print(3, 3 * i, 3 * i + 1, 3 * i + 2)
PYTHON
}

# bats test_tags=optimized
@test "a cube comes back with its corners and edges" {
  cubes whole | wrap --gap 8% -o cube.stl
  assert_equal "$(facts cube.stl)" "True 1.0 0.0 0.0 0.0 1.0 1.0 1.0"
}

# bats test_tags=optimized
@test "triangles turned any way are wrapped alike" {
  cubes turned | wrap --gap 8% -o cube.stl
  assert_equal "$(facts cube.stl)" "True 1.0 0.0 0.0 0.0 1.0 1.0 1.0"
}

@test "overlapping parts become one; what is inside goes, and is told" {
  cubes overlapping >two.off
  run wrap two.off --gap 6% -o two.stl --stats two.json
  assert_success
  assert_output --regexp "^wrap: warning: two.off: [0-9.]+ % of the input's area is not on the surface but up to 0.5 away"
  # The volume of both less that of the overlap; edges inward stay a little round.
  read -r closed volume _ <<<"$(facts two.stl)"
  assert_equal "$closed" True
  "$PYTHON" -c "assert abs($volume - 1.875) < 0.01, $volume"
  "$PYTHON" -c "import json; s = json.load(open('two.json')); assert s['distance_to_input']['greatest'] < 0.06 < 0.4 < s['distance_from_input']['greatest'], s"
  cubes inner | wrap --gap 8% -q -o inner.stl
  assert_equal "$(facts inner.stl)" "True 1.0 0.0 0.0 0.0 1.0 1.0 1.0"
}

# bats test_tags=optimized
@test "a hole wider than the gap is an error that says what to do, one that is narrower closes" {
  cubes open >open.off
  assert_fails_with 1 "^wrap: open.off: expected a surface that encloses a room .*; its widest hole, 3 edges around \(0.666667, 0.333333, 1\), is about 0.586 wide; close wider holes by a larger --gap" \
    wrap open.off --gap 4% -o no.stl
  assert [ ! -e no.stl ]
  wrap open.off --gap 90% -q -o closed.stl
  read -r closed volume _ <<<"$(facts closed.stl)"
  assert_equal "$closed" True
  "$PYTHON" -c "assert $volume > 0.8, $volume"
  # Without a room: a sheet has no other side.
  printf 'OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n' >sheet.off
  assert_fails_with 1 "^wrap: sheet.off: expected a surface that encloses a room .* only a shell" wrap sheet.off -o no.stl
}

# bats test_tags=optimized
@test "a fin goes and is told, so that tetmesh can fill the rest" {
  run wrap "$DATA/touching/fin-on-edge.off" --gap 6% -o body.stl
  assert_success
  assert_output --regexp "^wrap: warning: .*fin-on-edge.off: 1 triangle\(s\), 16 % of the input's area, have the outside on both sides and are left out"
  read -r closed volume _ <<<"$(facts body.stl)"
  assert_equal "$closed" True
  "$PYTHON" -c "assert abs($volume - 1) < 0.01, $volume"
  if command -v tetmesh; then tetmesh -q body.stl --size 0.3 -o body.mesh; fi
}

@test "tetmesh fills what comes out, with the input's groups" {
  if ! command -v tetmesh; then skip "tetmesh fills the surface"; fi
  cubes overlapping >two.off
  "$PYTHON" - <<'PYTHON' >two.obj
lines = open("two.off").read().split("\n")
count = int(lines[1].split()[1])
for point in lines[2:2 + 3 * count]:
    print("v", point)
for i in range(count):
    if i % 12 == 0:
        print("g", ["left", "right"][i // 12])
    print("f", 3 * i + 1, 3 * i + 2, 3 * i + 3)
PYTHON
  wrap two.obj --gap 6% -q | tetmesh -q --size 0.3 --stats tets.json -o two.tar
  run "$PYTHON" -c "import json, tarfile; print(*json.load(tarfile.open('two.tar').extractfile('names.json'))['surfaces'].values())"
  assert_output "left right"
  "$PYTHON" -c "import json; v = json.load(open('tets.json'))['volume']; assert abs(v - 1.875) < 0.02, v"
}

# bats test_tags=optimized
@test "--feature-angle and --no-features change the result, and so does the gap" {
  cubes overlapping >two.off
  wrap -q two.off --gap 8% -o sharp.stl
  wrap -q two.off --gap 8% --no-features -o round.stl
  wrap -q two.off --gap 8% --feature-angle 100 -o blunt.stl
  wrap -q two.off --gap 7% -o fine.stl
  for other in round blunt fine; do assert_different_bytes sharp.stl $other.stl; done
  assert_same_bytes round.stl blunt.stl
  wrap -q two.off --gap 8% -o again.stl
  assert_same_bytes sharp.stl again.stl
}

@test "wrong input and options" {
  cubes whole >cube.off
  assert_fails_with 2 "^wrap: --gap: expected a positive length" wrap cube.off --gap 0 -o no.stl
  assert_fails_with 2 "^wrap: --gap: expected a positive length" wrap cube.off --gap much -o no.stl
  assert_fails_with 2 "^wrap: --gap: expected from .* to the diagonal of the surface" wrap cube.off --gap 200% -o no.stl
  assert_fails_with 2 "expected a surface as obj, stl, msh or tar" wrap cube.off -o no.vtu
  assert_fails_with 1 "^wrap: missing.off: .*No such file" wrap missing.off -o no.stl
  printf 'OFF\n3 1 0\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n' >flat.off
  assert_fails_with 1 "^wrap: flat.off: expected triangles with an area, found none" wrap flat.off -o no.stl
  : >empty.off
  assert_fails_with 1 "^wrap: empty.off: " wrap empty.off -o no.stl
  assert_fails_with 1 "^wrap: /dev/full: cannot write" wrap -q cube.off --gap 20% -o /dev/full
  assert [ ! -e no.stl ]
  assert [ ! -e no.vtu ]
}
