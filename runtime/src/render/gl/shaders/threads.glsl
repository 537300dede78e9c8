layout(local_size_x = 64) in;

// The number of this thread within the dispatch. The work groups lie in rows; see dispatch() in
// C++.
uint threadNumber() {
  uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  return group * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
}
