// The geometry path makes everything in its geometry stage; a point only carries its number (gl_PrimitiveIDIn there).
void main() { gl_Position = vec4(0.0); }
