// A quiet studio sweep behind everything: dark above, lighter towards the floor, a faint pool of light behind the
// subject.
vec3 backdropColor(vec2 screen) {
  vec3 sweep = mix(backdrop_bottom.rgb, backdrop_top.rgb, smoothstep(-0.1, 0.95, screen.y));
  vec2 from_middle = (screen - vec2(0.5, 0.55)) * vec2(1.3, 0.9);
  return sweep * (0.55 + 0.9 * exp(-4.5 * dot(from_middle, from_middle)));
}
