// The mean of the last pictures (post.motion-blur-accumulation). Summed up as differences from the newest: where they
// are equal, so is their mean, to the bit.
#version 450

layout(binding = 0) uniform sampler2DArray pictures;

uniform int newest;  // layer
uniform int count;   // of pictures, in the layers before it, round the end
uniform int window;  // layers

layout(location = 0) out vec4 mean;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 last = texelFetch(pictures, ivec3(at, newest), 0);
    vec4 sum = vec4(0.0);
    for (int i = 1; i < count; ++i) {
        sum += texelFetch(pictures, ivec3(at, (newest - i + window) % window), 0) - last;
    }
    mean = last + sum / float(count);
}
