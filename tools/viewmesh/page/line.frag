// Lines inside the mesh are seen through it, but fainter. Those that are clipped away are not drawn.
uniform sampler2D depths;
uniform vec2 pixel;  // of the picture, as a part of it
uniform vec4 clip;   // a normal, and how far along it the picture goes
uniform vec3 line_colour;
in vec3 place;
out vec4 result;

void main() {
  if (dot(clip.xyz, place) > clip.w) discard;
  bool is_hidden = gl_FragCoord.z > texture(depths, gl_FragCoord.xy * pixel).r + 1e-6;
  result = vec4(line_colour, is_hidden ? 0.5 : 1.0);
}
