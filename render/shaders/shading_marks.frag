// The divider of a comparison, columns with their names, a scanline and the plot of its brightness, over the image (shading_marks_pass.h).
// Techniques: fakephong.metric-scanline
#version 450
#include "lib/small_text.glsl"
#include "lib/tone.glsl"
#include "fullscreen_gpu.h"
#include "shading_comparison_gpu.h"

layout(binding = kSourceUnit) uniform sampler2D scene_radiance;
layout(binding = kLeftRadianceUnit) uniform sampler2D left_radiance;
layout(binding = kRightRadianceUnit) uniform sampler2D right_radiance;

uniform float row;          // 0 .. 1 from below
uniform float plot_height;  // of the image; 0: no plot
uniform float divider;      // of the width; negative: none
uniform int curves;         // 1: of the left image only
uniform mat4 left_label;    // glyphs of lib/small_text.glsl, three in each number, lowest byte first
uniform mat4 right_label;
uniform ivec2 label_lengths;     // left, right; without a divider only the left one, centered
uniform int columns;             // of the same width, each with a name; 0: none
uniform vec2 column_borders;     // of the first and the last, 0 .. 1 of the width
uniform mat4 column_labels_low;  // of the first four, then of the others, as left_label
uniform mat4 column_labels_high;
uniform vec4 column_lengths_low;
uniform vec4 column_lengths_high;

layout(location = 0) out vec4 radiance;

// sRGB
const vec3 kLeft = vec3(0.98, 0.66, 0.26);
const vec3 kRight = vec3(0.36, 0.70, 1.0);
const vec3 kPaper = vec3(0.055, 0.065, 0.085);
const vec3 kGrid = vec3(0.36, 0.40, 0.47);
const vec3 kMark = vec3(0.96, 0.97, 0.98);
const float kPadding = 0.12;  // of the plot's height, below 0 and above 1

vec3 image_color;

void paint(vec3 srgb, float opacity) {
    image_color = mix(image_color, srgb_to_linear(srgb), clamp(opacity, 0.0, 1.0));
}

// (r + g + b) / 3 of a pixel of the row (thesis, equation 6.3).
float brightness(sampler2D image, int x) {
    ivec2 size = textureSize(image, 0);
    int y = clamp(int(row * float(size.y)), 0, size.y - 1);
    vec4 c = texelFetch(image, ivec2(clamp(x, 0, size.x - 1), y), 0);
    return dot(clamp(c.rgb, 0.0, 1.0), vec3(1.0 / 3.0));
}

float distance_to_segment(vec2 p, vec2 a, vec2 b) {
    vec2 d = b - a;
    return distance(p, a + clamp(dot(p - a, d) / dot(d, d), 0.0, 1.0) * d);
}

// Height in the plot of a brightness [px].
float plotted(float value, float plot) {
    return plot * (kPadding + (1.0 - 2.0 * kPadding) * value);
}

// 1 on the curve, 0 beyond half its `width` [px].
float curve(sampler2D image, vec2 p, float plot, float width) {
    int x = int(p.x);
    float nearest = 1e9;
    int radius = int(ceil(width)) + 1;
    vec2 last = vec2(float(x - radius) + 0.5, plotted(brightness(image, x - radius), plot));
    for (int i = 1 - radius; i <= radius; ++i) {
        vec2 next = vec2(float(x + i) + 0.5, plotted(brightness(image, x + i), plot));
        nearest = min(nearest, distance_to_segment(p, last, next));
        last = next;
    }
    return clamp(0.5 * width + 0.5 - nearest, 0.0, 1.0);
}

void paint_plot(vec2 p, float plot, float unit) {
    paint(kPaper, 0.88);
    for (int i = 0; i <= 4; ++i) {
        float line = clamp(1.0 - abs(p.y - plotted(0.25 * float(i), plot)), 0.0, 1.0);
        paint(kGrid, line * (i % 4 == 0 ? 0.75 : 0.3));
    }
    if (curves > 1) {
        float left = plotted(brightness(left_radiance, int(p.x)), plot);
        float right = plotted(brightness(right_radiance, int(p.x)), plot);
        float inside = clamp(max(left, right) - p.y + 0.5, 0.0, 1.0)
                       * clamp(p.y - min(left, right) + 0.5, 0.0, 1.0);
        paint(left > right ? kLeft : kRight, 0.22 * inside);
        paint(kRight, curve(right_radiance, p, plot, 1.8 * unit));
    }
    paint(kLeft, curve(left_radiance, p, plot, 1.8 * unit));
    paint(kMark, 0.5 * clamp(1.0 - abs(p.y - plot + 0.5), 0.0, 1.0));
}

// A line with a round handle that has an arrow to each side, and above the color of each side.
void paint_divider(vec2 p, vec2 size, float unit) {
    float x = p.x - floor(divider * size.x);
    float top = size.y - p.y;
    paint(x < 0.0 ? kLeft : kRight, 0.95 * clamp(4.0 * unit - top, 0.0, 1.0));
    paint(vec3(0.0), 0.45 * (1.0 - smoothstep(1.0 * unit, 4.0 * unit, abs(x))));
    paint(kMark, clamp(0.8 * unit + 0.5 - abs(x), 0.0, 1.0));
    vec2 q = vec2(x, p.y - 0.5 * size.y) / unit;
    float from_handle = length(q);
    paint(vec3(0.0), 0.35 * (1.0 - smoothstep(13.0, 19.0, from_handle)));
    paint(kMark, clamp((13.0 - from_handle) * unit + 0.5, 0.0, 1.0));
    float arrow = min(8.0 - abs(q.x) - abs(q.y), abs(q.x) - 2.5);  // a triangle to each side
    paint(kPaper, clamp(arrow * unit + 0.5, 0.0, 1.0));
}

// A label on a dark plate; `from` is its upper left corner [px], `dot` the side of a dot.
void paint_label(mat4 glyphs, int count, vec2 from, float dot_size, vec3 srgb) {
    vec2 at = (gl_FragCoord.xy - from) * vec2(1.0, -1.0) / dot_size;  // y down [dots]
    vec2 extent = vec2(float(count), 1.0) * kGlyphCell - 1.0;
    vec2 outside = max(-at, at - extent);
    if (count > 0 && max(outside.x, outside.y) < 3.0) {
        paint(kPaper, 0.85);
        ivec2 dot = ivec2(floor(at));
        int i = dot.x / int(kGlyphCell.x);
        if (dot.x >= 0 && i < count) {
            int glyph = int(glyphs[i / 12][i / 3 % 4]) >> 8 * (i % 3) & 255;
            paint(srgb, has_dot(glyph, ivec2(dot.x % int(kGlyphCell.x), dot.y)) ? 1.0 : 0.0);
        }
    }
}

void paint_labels(vec2 size, float plot, float unit) {
    float dot_size = max(floor(2.0 * unit), 1.0);
    float top = plot + 16.0 * dot_size;
    vec2 widths = vec2(label_lengths) * kGlyphCell.x * dot_size;
    float gap = 10.0 * dot_size;
    if (divider < 0.0) {
        paint_label(left_label, label_lengths.x, floor(vec2(0.5 * (size.x - widths.x), top)), dot_size, kMark);
        return;
    }
    float x = floor(divider * size.x);
    paint_label(left_label, label_lengths.x, floor(vec2(x - gap - widths.x, top)), dot_size, kLeft);
    paint_label(right_label, label_lengths.y, floor(vec2(x + gap, top)), dot_size, kRight);
}

// Lines between columns, and their names below, on two levels where they are too wide for one.
void paint_columns(vec2 p, vec2 size, float plot, float unit) {
    float begin = column_borders.x * size.x;
    float width = (column_borders.y - column_borders.x) * size.x / float(columns);
    float edge = round((p.x - begin) / width);
    if (edge > 0.5 && edge < float(columns) - 0.5) {
        float x = abs(p.x - floor(begin + edge * width));
        paint(vec3(0.0), 0.45 * (1.0 - smoothstep(1.0 * unit, 4.0 * unit, x)));
        paint(kMark, clamp(0.8 * unit + 0.5 - x, 0.0, 1.0));
    }
    float dot_size = max(floor(2.0 * unit), 1.0);
    bool two_levels = width < 12.0 * kGlyphCell.x * dot_size;
    for (int i = 0; i < columns; ++i) {
        mat4 glyphs = mat4(0.0);
        glyphs[0] = i < 4 ? column_labels_low[i] : column_labels_high[i - 4];
        int count = int(i < 4 ? column_lengths_low[i] : column_lengths_high[i - 4]);
        float left = begin + (float(i) + 0.5) * width - 0.5 * float(count) * kGlyphCell.x * dot_size;
        float top = plot + (two_levels && i % 2 == 1 ? 32.0 : 16.0) * dot_size;
        paint_label(glyphs, count, floor(vec2(left, top)), dot_size, kMark);
    }
}

void main() {
    vec2 p = gl_FragCoord.xy;
    vec2 size = vec2(textureSize(scene_radiance, 0));
    float unit = max(size.y / 720.0, 0.5);  // [px]
    vec4 scene = texelFetch(scene_radiance, ivec2(p), 0);
    image_color = scene.rgb;
    float plot = floor(plot_height * size.y);
    if (plot_height > 0.0) {
        float dashes = step(0.5, fract(p.x / (12.0 * unit)));
        float line = clamp(0.5 * unit + 0.5 - abs(p.y - floor(row * size.y) - 0.5), 0.0, 1.0);
        paint(kMark, 0.6 * line * dashes);
    }
    if (divider >= 0.0) {
        paint_divider(p, size, unit);
    }
    if (p.y < plot) {
        paint_plot(p, plot, unit);
    }
    paint_labels(size, plot, unit);
    if (columns > 0) {
        paint_columns(p, size, plot, unit);
    }
    radiance = vec4(image_color, scene.a);
}
