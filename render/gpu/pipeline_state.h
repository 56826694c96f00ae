#pragma once

#include <epoxy/gl.h>

#include <cstdint>

namespace limn::gpu {

// The fixed-function state of a draw, as one plain value. Device::apply() sets only what differs
// from the current state. The default draws opaque triangles with reversed depth.
// Techniques: shade.pipeline-model

struct DepthState {
    bool test = true;
    bool write = true;
    GLenum func = GL_GREATER;  ///< nearer is greater: depth is reversed

    bool operator==(const DepthState&) const = default;
};

struct BlendState {
    bool enabled = false;
    GLenum source = GL_ONE;
    GLenum destination = GL_ZERO;
    GLenum source_alpha = GL_ONE;
    GLenum destination_alpha = GL_ZERO;
    GLenum equation = GL_FUNC_ADD;  ///< of color and alpha

    bool operator==(const BlendState&) const = default;
};

inline constexpr BlendState kBlendOff = {};
/// result = source + (1 - source alpha) destination
inline constexpr BlendState kBlendPremultiplied = {
    true, GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA};
inline constexpr BlendState kBlendAlpha = {
    true, GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA};
inline constexpr BlendState kBlendAdd = {true, GL_ONE, GL_ONE, GL_ONE, GL_ONE};
/// result = (1 - source) destination
inline constexpr BlendState kBlendTransmit = {
    true, GL_ZERO, GL_ONE_MINUS_SRC_COLOR, GL_ZERO, GL_ONE_MINUS_SRC_ALPHA};
inline constexpr BlendState kBlendMultiply = {true, GL_DST_COLOR, GL_ZERO, GL_DST_ALPHA, GL_ZERO};

struct StencilFace {
    GLenum func = GL_ALWAYS;
    GLenum stencil_fail = GL_KEEP;
    GLenum depth_fail = GL_KEEP;
    GLenum pass = GL_KEEP;

    bool operator==(const StencilFace&) const = default;
};

struct StencilState {
    bool test = false;
    std::uint8_t reference = 0;
    std::uint8_t read_mask = 0xff;
    std::uint8_t write_mask = 0xff;
    StencilFace front = {};
    StencilFace back = {};

    bool operator==(const StencilState&) const = default;
};

struct PipelineState {
    DepthState depth = {};
    BlendState blend = {};
    BlendState second_blend = {};  ///< of color target 1; as `blend` unless enabled
    StencilState stencil = {};
    GLenum cull = GL_BACK;  ///< GL_NONE, GL_FRONT, GL_BACK; counterclockwise is the front
    std::uint8_t color_mask = 0b1111;  ///< bit 0 red .. bit 3 alpha
    bool depth_clamp = false;
    bool clip = false;  ///< by gl_ClipDistance[0], which the vertex shader must write
    bool wireframe = false;
    bool alpha_to_coverage = false;
    float depth_bias = 0;  ///< units of glPolygonOffset; positive is nearer, as depth is reversed
    float depth_bias_slope = 0;  ///< factor of glPolygonOffset

    bool operator==(const PipelineState&) const = default;
};

/// For passes that cover the screen with one triangle: no depth, no culling.
inline constexpr PipelineState kFullscreenState = {
    .depth = {.test = false, .write = false}, .cull = GL_NONE};

}  // namespace limn::gpu
