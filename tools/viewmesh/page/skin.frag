// Soft light from above and from the left of the camera, and edges one line wide however far away.
uniform float edge_width;  // pixels; 0: no edges
in vec3 view_position, view_normal, corner;
in vec3 paint;
in float up;
out vec4 result;

void main() {
  vec3 n = normalize(view_normal);
  if (dot(n, view_position) > 0.0) n = -n;
  float key = max(dot(n, normalize(vec3(-0.45, 0.65, 0.75))), 0.0);
  float fill = max(dot(n, normalize(vec3(0.8, 0.05, 0.5))), 0.0);
  float light = 0.44 + 0.10 * up + 0.66 * key + 0.22 * fill;
  vec3 lit = pow(paint, vec3(2.2)) * light;

  // Where cells are smaller than a few pixels, edges would cover everything.
  vec3 step = fwidth(corner);
  vec3 distance = corner / max(step, vec3(1e-6));
  float nearest = min(min(distance.x, distance.y), distance.z);
  float size = max(max(step.x, step.y), step.z) * max(edge_width, 1.0);
  float line = 1.0 - smoothstep(0.5 * edge_width - 0.5, 0.5 * edge_width + 0.7, nearest);
  line *= edge_width > 0.0 ? 0.78 * (1.0 - smoothstep(0.12, 0.7, size)) : 0.0;
  lit = mix(lit, lit * 0.10, line);
  result = vec4(pow(clamp(lit, 0.0, 1.0), vec3(1.0 / 2.2)), 1.0);
}
