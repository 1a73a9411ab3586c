// Skins a vertex of a body: joint matrices come as three rows each in a float buffer texture.

layout(binding = kUnitJoints) uniform samplerBuffer joint_rows;
layout(location = 0) in vec3 rest_position;
layout(location = 1) in vec3 rest_normal;
layout(location = 2) in uvec4 joints;
layout(location = 3) in vec4 weights;
layout(location = 4) in vec2 root_cover;  // 0 bare skin .. 1 among the roots of a hair; m that these lie under it
layout(location = 5) in float cloth;  // m from a garment's edge, negative under it
layout(location = 0) uniform mat4 clip_from_world;

void skin(out vec3 world, out vec3 normal) {
  vec4 rows[3] = vec4[3](vec4(0.0), vec4(0.0), vec4(0.0));
  for (int k = 0; k < 4; ++k) {
    if (weights[k] <= 0.0) continue;
    for (int row = 0; row < 3; ++row) rows[row] += weights[k] * texelFetch(joint_rows, int(joints[k]) * 3 + row);
  }
  vec4 p = vec4(rest_position - root_cover.y * rest_normal, 1.0);
  world = vec3(dot(rows[0], p), dot(rows[1], p), dot(rows[2], p));
  normal = vec3(dot(rows[0].xyz, rest_normal), dot(rows[1].xyz, rest_normal), dot(rows[2].xyz, rest_normal));
}
