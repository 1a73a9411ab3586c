// Colours of a body: one, or those that its mesh brings along.
layout(binding = kUnitMaterials) uniform sampler2DArray materials;

// place: u, v and the picture's number. Where derivatives are to be had.
vec3 materialColor(vec3 place) {
  return paint.y > 0.0 ? texture(materials, place).rgb : body_color.rgb;
}

// The same of a vertex, of the picture at that level of detail.
vec3 materialColorAt(vec3 place, float level) {
  return paint.y > 0.0 ? textureLod(materials, place, level).rgb : body_color.rgb;
}
