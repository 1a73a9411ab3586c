// The number of an invocation of a compute shader, whose groups stand in rows (render/hair/stored_points.h).
int invocation() {
  return int((gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x);
}
