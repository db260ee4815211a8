// A straight line as two triangles of a width in pixels. Each vertex has one end, the other end and its side, seen along
// the line from here: 1 left, -1 right.
uniform mat4 modelViewMatrix, projectionMatrix;
uniform vec2 viewport;  // pixels
uniform float width;
in vec3 position;
in vec3 other;
in float side;
out vec3 place;

void main() {
  vec4 here = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  vec4 there = projectionMatrix * modelViewMatrix * vec4(other, 1.0);
  vec2 along = (there.xy / max(there.w, 1e-4) - here.xy / max(here.w, 1e-4)) * viewport;
  vec2 across = vec2(-along.y, along.x) / max(length(along), 1e-6);
  here.xy += side * width * across / viewport * here.w;
  place = position;
  gl_Position = here;
}
