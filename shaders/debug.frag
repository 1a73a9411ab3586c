layout(location = 0) in vec4 shown;
layout(location = 0) out vec4 color;
void main() { color = shown; }
