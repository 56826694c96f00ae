// Instanced quads, one per tile of the given kinds.
#version 450
#include "lib/depth_of_field.glsl"
#include "depth_of_field_gpu.h"

layout(binding = kFocusTilesUnit) uniform sampler2D focus_tiles;
layout(binding = kFocusSlightTilesUnit) uniform sampler2D slight_tiles;

uniform int kind;          // bits of the tiles to draw, see below
uniform vec2 target_size;  // in full-resolution [px]: slightly larger than the image if half its size is rounded up

flat out vec4 tile;

const int kSharp = 1;   // nothing is out of focus
const int kSlight = 2;  // only small circles
const int kBlurred = 4;
const int kBlurredSlight = 8;  // both

void main() {
    ivec2 position = ivec2(gl_InstanceID % focus.tiles.x, gl_InstanceID / focus.tiles.x);
    tile = texelFetch(focus_tiles, position, 0);
    bool blurred = max(tile.x, max(tile.y, tile.z)) > 0.0;
    vec2 slight = texelFetch(slight_tiles, position, 0).xy;
    bool has_slight = max(slight.x, slight.y) > 0.0;
    int kinds = blurred ? (has_slight ? kBlurredSlight : kBlurred) : (has_slight ? kSlight : kSharp);
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    vec2 ndc = (vec2(position) + corner) * float(kFocusTile) / target_size * 2.0 - 1.0;
    gl_Position = (kinds & kind) != 0 ? vec4(ndc, 0.0, 1.0) : vec4(2.0, 2.0, 0.0, 1.0);
}
