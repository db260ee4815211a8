# findhex: the candidates are those of the definitions, and each option means what it says. What all tools do alike is in
# behaviour.bats.

load helpers

ALL_KINDS="--cells hex,prism,pyramid"

# column N FILE: of the lines after the header
column() { tail -n +2 "$2" | cut -d ' ' -f "$1"; }

count() { tail -n +2 "$1" | wc -l; }

lattice() { $PYTHON "$DATA/lattices/lattice.py" "$@"; }

# agrees MESH OPTIONS...: the same candidates as by the independent checker.
agrees() {
  local mesh=$1
  shift
  findhex -q --mesh "$mesh" "$@" -o found.cand
  if sanitized; then return; fi # the checker finds in the optimized half what it would find here
  run "$CHECKERS/candidates_check.py" "$mesh" found.cand "$@"
  assert_success
  assert_output --partial " 0 missing, 0 extra, 0 with other tets"
}

# two_regions MESH: every other tet by its first vertex, and boundary triangles of two tags.
two_regions() {
  awk '/^Tetrahedra/ { print; getline; print; tets = 1; next }
       /^End/ { tets = 0 }
       tets { $5 = 1 + ($1 > 32) }
       { print }' "$1"
}

# bats test_tags=both
@test "the lattices have the published numbers of candidates, conflicts and conflicts at a candidate" {
  local rows=0
  while IFS=, read -r name n _ _ quality candidates edges degree _; do
    if ((n > 10)) || [[ -z "$edges" ]] || { sanitized && ((n > 4)); }; then continue; fi
    lattice "$name" "$n" >l.mesh
    findhex -q --mesh l.mesh --min-quality "$quality" --folded-quads keep --flat-corners keep --max-boundary-tets 5 --quality corner |
      buildgraph --stats stats.json -o l.graph
    run $PYTHON -c "
import json
s = json.load(open('stats.json'))
print(s['vertices'], s['edges'], s['max_degree'])"
    assert_output "$candidates $edges $degree"
    rows=$((rows + 1))
  done < <(grep -E '^(kuhn|five),' "$DATA/lattices/counts.csv")
  assert [ $rows -ge 10 ]
}

# bats test_tags=optimized
@test "large lattices have the published numbers of candidates" {
  lattice kuhn 20 >k.mesh
  findhex -q --mesh k.mesh --folded-quads keep --flat-corners keep --max-boundary-tets 5 --quality corner -o k.cand
  assert_equal "$(count k.cand)" 321740
  lattice five 20 >f.mesh
  findhex -q --mesh f.mesh --folded-quads keep --flat-corners keep --max-boundary-tets 5 --quality corner -o f.cand
  assert_equal "$(count f.cand)" 62864
}

# bats test_tags=optimized
@test "hexes, prisms and pyramids of Delaunay meshes are those of an independent search" {
  for mesh in random_points jittered_lattice; do
    agrees "$DATA/$mesh.mesh" $ALL_KINDS --min-quality 0.1 --folded-quads keep --quality corner
    agrees "$DATA/$mesh.mesh" $ALL_KINDS --min-quality 0 --inner-vertices forbid --max-boundary-tets 2
  done
}

# bats test_tags=optimized
@test "so are those of meshes with regions and surface tags" {
  for mesh in random_points jittered_lattice; do
    two_regions "$DATA/$mesh.mesh" >regions.mesh
    agrees regions.mesh $ALL_KINDS
    findhex -q --mesh "$DATA/$mesh.mesh" $ALL_KINDS -o whole.cand
    assert [ "$(count found.cand)" -lt "$(count whole.cand)" ]
    # Tags on the boundary, every other triangle.
    $PYTHON - regions.mesh >tagged.mesh <<'PYTHON'
import itertools, sys
words = open(sys.argv[1]).read().split()
at = words.index("Tetrahedra")
n = int(words[at + 1])
tets = [words[at + 2 + 5 * i:at + 6 + 5 * i] for i in range(n)]
count = {}
for tet in tets:
    for facet in itertools.combinations(sorted(tet), 3):
        count[facet] = count.get(facet, 0) + 1
skin = sorted(f for f, c in count.items() if c == 1)
text = open(sys.argv[1]).read().replace("End\n", "")
print(text + "Triangles\n%d" % len(skin))
for i, facet in enumerate(skin):
    print(*facet, 5 + (int(facet[0]) > 20))
print("End")
PYTHON
    agrees tagged.mesh $ALL_KINDS
  done
}

# The published program starts its flood from any tet that joins four corners, and loses three of these.
@test "hexes are found where a tet outside joins four of their corners" {
  findhex -q --mesh "$DATA/random_points.mesh" --folded-quads keep --flat-corners keep --max-boundary-tets 5 -o found.cand
  assert_equal "$(count found.cand)" 170
}

# bats test_tags=optimized
@test "no quad lies over a sharp edge of the surface" {
  local mesh="$DATA/quad-folded-over-box-edge.mesh"
  agrees "$mesh"
  assert_equal "$(count found.cand)" 0
  findhex --mesh "$mesh" --stats stats.json -o found.cand
  assert_equal "$($PYTHON -c "
import json
print(json.load(open('stats.json'))['hexes']['rejected']['rule 10, a quad over a sharp edge of the surface'])")" 1
  agrees "$mesh" --feature-angle 100
  assert_equal "$(count found.cand)" 1
  agrees "$mesh" --folded-quads keep
  assert_equal "$(count found.cand)" 1
  # By any angle.
  for angle in 10 40 60; do
    agrees "$DATA/random_points.mesh" $ALL_KINDS --min-quality 0.1 --feature-angle $angle
    count found.cand >>counts.txt
  done
  run sort -nuc counts.txt
  assert_success
}

# bats test_tags=both
@test "ridges of a mesh are sharp edges, in a file and in a bundle" {
  lattice kuhn 3 >plain.mesh
  findhex -q --mesh plain.mesh -o plain.cand
  # The diagonal of a square on the surface, which is flat there, and an edge that is no ridge.
  $PYTHON - >ridge.mesh <<'PYTHON'
text = open("plain.mesh").read().replace("End", "")
words = text.split()
start = words.index("Vertices") + 2
points = [tuple(float(x) for x in words[start + 4 * i:start + 4 * i + 3]) for i in range(int(words[start - 1]))]
number = {p: i + 1 for i, p in enumerate(points)}
print(text + f"Ridges\n1\n2\nEdges\n2\n1 {number[1, 0, 0]} 0\n{number[2, 2, 0]} {number[1, 1, 0]} 0\nEnd")
PYTHON
  agrees ridge.mesh
  assert [ "$(count found.cand)" -lt "$(count plain.cand)" ]
  findhex -q --mesh ridge.mesh | findhex -q -o from_bundle.cand
  assert_same_bytes found.cand from_bundle.cand
  findhex -q --mesh ridge.mesh --folded-quads keep -o kept.cand
  findhex -q --mesh plain.mesh --folded-quads keep -o plain.cand
  assert_same_bytes kept.cand plain.cand
  sed '/^Ridges/,/^Edges/s/^2$/3/' ridge.mesh >wrong.mesh
  assert_fails_with 1 "findhex: .*expected Ridges of edges from 1 to 2, found 3" findhex --mesh wrong.mesh -o out.cand
  assert_fails_with 2 "findhex: .*--feature-angle does nothing with --folded-quads keep" \
    findhex --mesh plain.mesh --feature-angle 30 --folded-quads keep -o out.cand
}

@test "candidates come by kind, then by their first vertex; each once" {
  findhex -q --mesh "$DATA/random_points.mesh" $ALL_KINDS -o all.cand
  assert_equal "$(column 1 all.cand | uniq | tr '\n' ' ')" "hex prism pyramid "
  for kind in hex prism pyramid; do
    grep "^$kind " all.cand | cut -d ' ' -f 6 | sort -nc
    findhex -q --mesh "$DATA/random_points.mesh" --cells $kind -o $kind.cand
    diff <(grep "^$kind " all.cand) <(tail -n +2 $kind.cand)
  done
  # In whatever order they are asked for.
  findhex -q --mesh "$DATA/random_points.mesh" --cells pyramid,hex,prism,hex -o other.cand
  assert_same_bytes all.cand other.cand
  # A file may follow.
  findhex -q --cells hex,prism,pyramid "$DATA/random_points.mesh" -o other.cand
  assert_same_bytes all.cand other.cand
}

@test "every option changes something" {
  local mesh="$DATA/random_points.mesh"
  findhex -q --mesh "$mesh" -o plain.cand
  while read -r options; do
    findhex -q --mesh "$mesh" $options -o changed.cand
    assert_different_bytes plain.cand changed.cand
  done <<'OPTIONS'
--cells prism
--min-quality 0.5
--quality corner
--folded-quads keep
--feature-angle 5
--max-boundary-tets 0
OPTIONS
  # Twelve tets around the centre of a cube.
  printf '%s\n' 'MeshVersionFormatted 2' 'Dimension 3' 'Vertices' 9 '0 0 0 0' '2 0 0 0' '2 2 0 0' '0 2 0 0' '0 0 2 0' \
    '2 0 2 0' '2 2 2 0' '0 2 2 0' '1 1 1 0' 'Tetrahedra' 12 '9 1 4 3 1' '9 1 3 2 1' '9 5 6 7 1' '9 5 7 8 1' \
    '9 1 2 6 1' '9 1 6 5 1' '9 2 3 7 1' '9 2 7 6 1' '9 3 4 8 1' '9 3 8 7 1' '9 4 1 5 1' '9 4 5 8 1' End >centre.mesh
  findhex -q --mesh centre.mesh -o with.cand
  findhex -q --mesh centre.mesh --inner-vertices forbid -o without.cand
  assert_equal "$(count with.cand) $(count without.cand)" "1 0"
}

# bats test_tags=both
@test "cells that leave a flat corner at the surface are rejected, and no others" {
  local mesh="$DATA/jittered_lattice.mesh"
  findhex -q --mesh "$mesh" $ALL_KINDS --flat-corners keep -o kept.cand
  findhex -q --mesh "$mesh" $ALL_KINDS --flat-corners reject --stats stats.json -o rejected.cand
  findhex -q --mesh "$mesh" $ALL_KINDS -o default.cand
  assert_same_bytes rejected.cand default.cand
  assert [ "$(count rejected.cand)" -lt "$(count kept.cand)" ]
  run comm -13 <(tail -n +2 kept.cand | sort) <(tail -n +2 rejected.cand | sort)
  assert_output ""
  agrees "$mesh" $ALL_KINDS --flat-corners keep
}

@test "--quality says what is stored, not what is found" {
  findhex -q --mesh "$DATA/random_points.mesh" --quality corner -o corner.cand
  findhex -q --mesh "$DATA/random_points.mesh" --quality element -o element.cand
  findhex -q --mesh "$DATA/random_points.mesh" -o default.cand
  assert_same_bytes element.cand default.cand
  diff <(cut -d ' ' -f 1,3- corner.cand) <(cut -d ' ' -f 1,3- element.cand)
  paste -d ' ' <(column 2 corner.cand) <(column 2 element.cand) |
    awk '$1 <= 0.3 || $2 > $1 { exit 1 } $2 < $1 { less = 1 } END { if (!less) exit 1 }'
}

@test "bad options end with 2" {
  local mesh="$DATA/random_points.mesh"
  assert_fails_with 2 "findhex: .*--cells" findhex --mesh "$mesh" --cells tet -o out.cand
  assert_fails_with 2 "findhex: .*--cells" findhex --mesh "$mesh" --cells hex,cube -o out.cand
  assert_fails_with 2 "findhex: .*--min-quality" findhex --mesh "$mesh" --min-quality 1.5 -o out.cand
  assert_fails_with 2 "findhex: .*--min-quality" findhex --mesh "$mesh" --min-quality -0.1 -o out.cand
  assert_fails_with 2 "findhex: .*--min-quality" findhex --mesh "$mesh" --min-quality nan -o out.cand
  assert_fails_with 2 "findhex: .*--quality" findhex --mesh "$mesh" --quality best -o out.cand
  assert_fails_with 2 "findhex: .*--inner-vertices" findhex --mesh "$mesh" --inner-vertices maybe -o out.cand
  assert_fails_with 2 "findhex: .*--folded-quads" findhex --mesh "$mesh" --folded-quads no -o out.cand
  assert_fails_with 2 "findhex: .*--flat-corners" findhex --mesh "$mesh" --flat-corners drop -o out.cand
  assert_fails_with 2 "findhex: .*--max-boundary-tets" findhex --mesh "$mesh" --max-boundary-tets 7 -o out.cand
  assert_fails_with 2 "findhex: .*--max-boundary-tets" findhex --mesh "$mesh" --max-boundary-tets 2.5 -o out.cand
  assert [ ! -e out.cand ]
}

@test "inverted and flat tets are counted in a warning and not used" {
  # Vertex 22 of the lattice goes through its neighbourhood.
  lattice kuhn 3 | awk '$1 == 1 && $2 == 1 && $3 == 1 && NF == 4 { $1 = 2.2; $3 = 0.7 } { print }' >inverted.mesh
  run_apart findhex --mesh inverted.mesh -o out.cand
  assert_success
  assert_equal "$(wc -l <<<"$stderr")" 1
  [[ "$stderr" =~ ^findhex:\ warning:\ ([0-9]+)\ inverted\ and\ ([0-9]+)\ flat\ of\ 162\ tets ]]
  assert [ "${BASH_REMATCH[1]}" -gt 0 ]
  assert [ "$(count out.cand)" -gt 0 ]
  run_apart findhex --mesh inverted.mesh -q -o quiet.cand
  assert_equal "$stderr" ""
  assert_same_bytes out.cand quiet.cand
}

@test "a tet listed inside out among others is turned, with a warning" {
  lattice kuhn 2 >lattice.mesh
  findhex --mesh lattice.mesh -o lattice.tar
  findhex --mesh lattice.mesh -o lattice.cand
  $PYTHON "$DATA/change_array.py" lattice.tar odd.tar mesh/tets.npy 'np.vstack([a[:7], a[7:8, [1, 0, 2, 3]], a[8:]])'
  run_apart findhex odd.tar -o odd.cand
  assert_success
  assert_equal "$stderr" "findhex: warning: 1 of 48 tets listed inside out, unlike their neighbours: turned"
  assert_same_bytes lattice.cand odd.cand
}

@test "an isolated vertex does no harm; a facet of three tets is an error" {
  lattice kuhn 2 >lattice.mesh
  findhex --mesh lattice.mesh -o plain.cand
  sed -e 's/^27$/28/' -e 's/^Tetrahedra/9 9 9 0\nTetrahedra/' lattice.mesh >isolated.mesh
  findhex --mesh isolated.mesh -o isolated.cand
  assert_same_bytes plain.cand isolated.cand
  sed -e 's/^48$/49/' -e 's/^End/1 10 14 28 1\nEnd/' isolated.mesh >three.mesh
  assert_fails_with 1 "^findhex: .*at most two tets at each facet" findhex --mesh three.mesh -o out.cand
}

@test "two copies of a tet are an error" {
  printf '%s\n' "MeshVersionFormatted 2" "Dimension 3" Vertices 4 "0 0 0 0" "1 0 0 0" "0 1 0 0" "0 0 1 0" \
    Tetrahedra 2 "1 2 3 4 1" "1 2 3 4 1" End >twice.mesh
  assert_fails_with 1 "^findhex: twice.mesh: .*found tets 1 and 2 on one side of that at vertices [1-4] [1-4] [1-4]$" \
    findhex --mesh twice.mesh -o out.cand
}

@test "surface triangles are derived where there are none" {
  lattice kuhn 2 >lattice.mesh
  run_apart findhex --mesh lattice.mesh -v -o derived.cand
  assert_success
  grep -q "48 surface triangles derived, with tag 0" <<<"$stderr"
}

@test "the message about a surface instead of a mesh names tetmesh" {
  assert_fails_with 1 "cube.stl:1: expected a mesh .*tetmesh makes one of a surface.*found 'solid'$" findhex "$DATA/cube.stl"
}

@test "a mesh of other cells is an error" {
  printf 'MeshVersionFormatted 2\nDimension 3\nVertices\n8\n' >hex.mesh
  for p in '0 0 0' '1 0 0' '1 1 0' '0 1 0' '0 0 1' '1 0 1' '1 1 1' '0 1 1'; do echo "$p 0"; done >>hex.mesh
  printf 'Hexahedra\n1\n1 2 3 4 5 6 7 8 1\nEnd\n' >>hex.mesh
  assert_fails_with 1 "^findhex: .*expected tets and triangles only, found 1 hexes" findhex --mesh hex.mesh -o out.cand
}

@test "-v and --stats tell what was rejected, and why" {
  run_apart findhex --mesh "$DATA/random_points.mesh" -v --stats stats.json -o out.cand
  assert_success
  grep -Eq "[0-9]+ tets, [0-9]+ triangulated quads" <<<"$stderr"
  grep -q "rejected: rule 7, a quad half on a surface" <<<"$stderr"
  run $PYTHON -c "
import json
stats = json.load(open('stats.json'))
hexes = stats['hexes']
assert stats['candidates'] == hexes['candidates'] == $(count out.cand), stats
assert hexes['complete'] == hexes['candidates'] + sum(hexes['rejected'].values()), stats"
  assert_success
}

@test "a mesh without tets is an error" {
  printf 'MeshVersionFormatted 2\nDimension 3\nVertices\n3\n0 0 0 0\n1 0 0 0\n0 1 0 0\nTriangles\n1\n1 2 3 1\nEnd\n' >surface.mesh
  assert_fails_with 1 "^findhex: surface.mesh: mesh: expected tets, found none" findhex surface.mesh -o out.tar
}

@test "indices out of range are errors that name the file" {
  lattice kuhn 2 | sed 's/^1 10 14 13 1$/1 10 14 28 1/;s/^1 2 5 14 1$/1 2 5 28 1/' >range.mesh
  assert_different_bytes <(lattice kuhn 2) range.mesh
  assert_fails_with 1 "^findhex: range.mesh:.*28" findhex --mesh range.mesh -o out.cand
  assert [ ! -e out.cand ]
}

@test "tets that overlap without a common facet are searched as they are; flat ones are warned of" {
  # Two lattices, one through the other.
  lattice kuhn 2 >one.mesh
  $PYTHON - one.mesh >two.mesh <<'PYTHON'
import sys
lines = open(sys.argv[1]).read().splitlines()
v, t = lines.index("Vertices"), lines.index("Tetrahedra")
n, m = int(lines[v + 1]), int(lines[t + 1])
points, tets = lines[v + 2:v + 2 + n], lines[t + 2:t + 2 + m]
moved = [" ".join([str(float(x) + 0.3) for x in p.split()[:3]] + ["0"]) for p in points]
again = [" ".join([str(int(i) + n) for i in q.split()[:4]] + ["1"]) for q in tets]
print("MeshVersionFormatted 2\nDimension 3\nVertices\n%d" % (2 * n), *points, *moved, "Tetrahedra\n%d" % (2 * m), *tets,
      *again, "End", sep="\n")
PYTHON
  findhex --mesh one.mesh -o one.cand
  run_apart findhex --mesh two.mesh -o two.cand
  assert_success
  assert_equal "$(count two.cand)" $((2 * $(count one.cand)))
  # A tet of four points in a plane, beside the others.
  sed -e 's/^48$/49/' -e 's/^End/1 4 7 2 1\nEnd/' one.mesh >flat.mesh
  run_apart findhex --mesh flat.mesh -o flat.cand
  assert_success
  assert_equal "$stderr" "findhex: warning: 0 inverted and 1 flat of 49 tets: no candidate uses them"
}

@test "two regions that share a facet are searched each for itself" {
  lattice kuhn 3 >one.mesh
  two_regions one.mesh >two.mesh
  findhex --mesh one.mesh -o one.cand
  findhex --mesh two.mesh -o two.cand
  assert [ "$(count two.cand)" -gt 0 ]
  assert [ "$(count two.cand)" -lt "$(count one.cand)" ]
}

@test "parts put together by Makefile.examples are one run, byte for byte" {
  cp "$DATA/random_points.mesh" p.mesh
  findhex -q --mesh p.mesh -o whole.cand
  for shares in 1 3 7; do
    rm -f p.part*
    make -s -f "$BATS_TEST_DIRNAME/../Makefile.examples" BIN="$HEXPIPE_BIN" SHARES=$shares -j2 p.parts.cand
    assert_same_bytes whole.cand p.parts.cand
    make -s -f "$BATS_TEST_DIRNAME/../Makefile.examples" BIN="$HEXPIPE_BIN" SHARES=$shares p.parts.graph
    buildgraph -q whole.cand -o whole.graph
    assert_same_bytes whole.graph p.parts.graph
  done
  assert [ "$(count p.part4.cand)" -lt "$(count whole.cand)" ]
  # Kinds do not mix.
  findhex -q --mesh p.mesh $ALL_KINDS -o kinds.cand
  for i in 1 2; do findhex -q --mesh p.mesh $ALL_KINDS --part $i/2 -o kinds.part$i.cand; done
  touch kinds.mesh -d yesterday
  make -s -f "$BATS_TEST_DIRNAME/../Makefile.examples" BIN="$HEXPIPE_BIN" SHARES=2 kinds.parts.cand
  assert_same_bytes kinds.cand kinds.parts.cand
  for part in 0/2 3/2 1 1/ /2 a/b 1/2/3 -1/2 1/0 1.5/2; do
    assert_fails_with 2 "findhex: .*--part" findhex --mesh p.mesh --part "$part" -o out.cand
    assert_fails_with 2 "buildgraph: .*--part" buildgraph whole.cand --part "$part" -o out.graph
  done
}
