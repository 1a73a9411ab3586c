// Colour of a body: one, or with OWN_MATERIALS those that its mesh brings along. place: u, v and the picture's number.
#ifdef OWN_MATERIALS
layout(binding = kUnitMaterials) uniform sampler2DArray materials;

// Where derivatives are to be had.
vec3 materialColor(vec3 place) { return texture(materials, place).rgb; }

// At a vertex, of the picture at that level of detail.
vec3 materialColorAt(vec3 place, float level) { return textureLod(materials, place, level).rgb; }
#else
vec3 materialColor(vec3 place) { return body_color.rgb; }
vec3 materialColorAt(vec3 place, float level) { return body_color.rgb; }
#endif
