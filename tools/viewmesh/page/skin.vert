// A facet of the skin: three corners a triangle, each with the facet's normal and colour. The fourth byte of the colour
// says which corner this is (0 to 2) and, by bits 2 to 4, which sides of the triangle are the diagonal of a quad, and so
// are not drawn as edges: bit 2 + i is the side opposite corner i.
uniform mat4 modelViewMatrix, projectionMatrix;
uniform vec3 up_axis;
in vec3 position;
in vec3 normal;
in vec4 colour;
out vec3 view_position, view_normal, corner;
out vec3 paint;
out float up;

void main() {
  int code = int(colour.a * 255.0 + 0.5);
  int hidden = code / 4, own = code - 4 * hidden;
  vec3 inner = vec3(float(hidden - 2 * (hidden / 2)), float(hidden / 2 - 2 * (hidden / 4)), float(hidden / 4));
  corner = vec3(own == 0 ? 1.0 : 0.0, own == 1 ? 1.0 : 0.0, own == 2 ? 1.0 : 0.0) + inner;
  vec4 at = modelViewMatrix * vec4(position, 1.0);
  view_position = at.xyz;
  view_normal = mat3(modelViewMatrix) * normal;
  up = dot(normal, up_axis);
  paint = colour.rgb;
  gl_Position = projectionMatrix * at;
}
