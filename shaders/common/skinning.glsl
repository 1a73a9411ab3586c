// Skins a vertex of a body. The float buffer texture holds, after one texel with the texels of a joint: two, a dual
// quaternion (Kavan et al. 2007; render/body/skinning.h), or three, the rows of a matrix, where joints scale.

layout(binding = kUnitJoints) uniform samplerBuffer joint_motions;
layout(location = 0) in vec3 rest_position;
layout(location = 1) in vec3 rest_normal;
layout(location = 2) in uvec4 joints;
layout(location = 3) in vec4 weights;
layout(location = 4) in vec2 root_cover;  // 0 bare skin .. 1 among the roots of a hair; m that these lie under it
layout(location = 5) in float cloth;      // m from a garment's edge, negative under it
layout(location = 6) in vec3 material_place;  // u, v and number of a picture of materials.glsl
layout(location = 0) uniform mat4 clip_from_world;

void skinRigid(vec3 rest, out vec3 world, out vec3 normal) {
  vec4 real = vec4(0.0), dual = vec4(0.0), first = texelFetch(joint_motions, 1 + 2 * int(joints.x));
  for (int k = 0; k < 4; ++k) {
    if (weights[k] <= 0.0) continue;
    vec4 turn = texelFetch(joint_motions, 1 + 2 * int(joints[k]));
    float weight = dot(turn, first) < 0.0 ? -weights[k] : weights[k];
    real += weight * turn;
    dual += weight * texelFetch(joint_motions, 2 + 2 * int(joints[k]));
  }
  float norm = length(real);
  real /= norm;
  dual /= norm;
  world = rest + 2.0 * cross(real.xyz, cross(real.xyz, rest) + real.w * rest) +
          2.0 * (real.w * dual.xyz - dual.w * real.xyz + cross(real.xyz, dual.xyz));
  normal = rest_normal + 2.0 * cross(real.xyz, cross(real.xyz, rest_normal) + real.w * rest_normal);
}

void skinByMatrices(vec3 rest, out vec3 world, out vec3 normal) {
  vec4 rows[3] = vec4[3](vec4(0.0), vec4(0.0), vec4(0.0));
  for (int k = 0; k < 4; ++k) {
    if (weights[k] <= 0.0) continue;
    for (int row = 0; row < 3; ++row) rows[row] += weights[k] * texelFetch(joint_motions, 1 + int(joints[k]) * 3 + row);
  }
  vec4 p = vec4(rest, 1.0);
  world = vec3(dot(rows[0], p), dot(rows[1], p), dot(rows[2], p));
  normal = vec3(dot(rows[0].xyz, rest_normal), dot(rows[1].xyz, rest_normal), dot(rows[2].xyz, rest_normal));
}

void skin(out vec3 world, out vec3 normal) {
  vec3 rest = rest_position - root_cover.y * rest_normal;
  if (texelFetch(joint_motions, 0).x == 2.0)
    skinRigid(rest, world, normal);
  else
    skinByMatrices(rest, world, normal);
}
