// Filmic curve, Narkowicz 2015: y = x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14), and its inverse, the positive root
// of the quadratic. Then the sRGB transfer curve (IEC 61966-2-1).
vec3 film(vec3 x) { return clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0); }

vec3 filmInverse(vec3 y) {
  y = clamp(y, 0.0, 0.99);
  vec3 a = 2.51 - 2.43 * y, b = 0.03 - 0.59 * y, c = -0.14 * y;
  return (-b + sqrt(max(b * b - 4.0 * a * c, 0.0))) / (2.0 * a);
}

vec3 encodeSrgb(vec3 linear) {
  return mix(linear * 12.92, 1.055 * pow(max(linear, vec3(1e-6)), vec3(1.0 / 2.4)) - 0.055,
             greaterThan(linear, vec3(0.0031308)));
}

vec3 decodeSrgb(vec3 coded) {
  return mix(coded / 12.92, pow((max(coded, vec3(0.04045)) + 0.055) / 1.055, vec3(2.4)),
             greaterThan(coded, vec3(0.04045)));
}
