// Darkens what little light reaches, judged by the depths around: McGuire, Mara, Luebke, "Scalable Ambient Obscurance",
// High Performance Graphics 2012, section 2, without its depth pyramid and blur: more samples and the smaller
// final picture make up for them.
uniform sampler2D image, depths;
uniform vec2 pixel;           // of the image, as a part of it
uniform vec2 half_frustum;    // tangents of half the angles of view
uniform vec2 near_far;
uniform float reach;          // in the scene's units
uniform vec3 top, bottom;     // of the background
in vec2 at;
out vec4 result;

const int samples = 28;
const float turns = 11.0;

float distance_at(vec2 where) {
  float depth = 2.0 * texture(depths, where).r - 1.0;
  return 2.0 * near_far.x * near_far.y / (near_far.y + near_far.x - depth * (near_far.y - near_far.x));
}

vec3 place_at(vec2 where) {
  float far = distance_at(where);
  return vec3((2.0 * where - 1.0) * half_frustum * far, -far);
}

// The difference to the neighbour that is on the same surface, if one of them is.
vec3 slope(vec3 here, vec2 step) {
  vec3 ahead = place_at(at + step) - here, back = here - place_at(at - step);
  return abs(ahead.z) < abs(back.z) ? ahead : back;
}

void main() {
  vec3 background = mix(bottom, top, smoothstep(0.0, 1.0, at.y));
  float dither = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
  if (texture(depths, at).r >= 1.0) {
    result = vec4(background + (dither - 0.5) / 255.0, 1.0);
    return;
  }
  vec3 here = place_at(at);
  vec3 n = normalize(cross(slope(here, vec2(pixel.x, 0.0)), slope(here, vec2(0.0, pixel.y))));
  vec2 disk = reach / (2.0 * half_frustum * -here.z);
  float sum = 0.0;
  for (int i = 0; i < samples; ++i) {
    float part = (float(i) + 0.5) / float(samples);
    float angle = 6.2831853 * (part * turns + dither);
    vec3 towards = place_at(at + part * disk * vec2(cos(angle), sin(angle))) - here;
    float squared = dot(towards, towards);
    float inside = max(reach * reach - squared, 0.0);
    sum += inside * inside * inside * max((dot(towards, n) - 0.02 * reach) / (squared + 0.002 * reach * reach), 0.0);
  }
  float open = max(0.0, 1.0 - sum * 2.6 / (pow(reach, 5.0) * float(samples)));
  result = vec4(texture(image, at).rgb * mix(0.30, 1.0, open), 1.0);
}
