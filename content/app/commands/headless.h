#pragma once

#include "ecs/base/math.h"
#include "ecs/base/result.h"
#include "ecs/entity.h"
#include "render/gpu/context.h"
#include "render/gpu/device.h"
#include "render/render_frame.h"

#include <memory>
#include <optional>

namespace limn {

/// What rendering without a window needs; members are destroyed in the order OpenGL requires.
struct HeadlessRenderer {
    std::unique_ptr<gpu::Context> context;
    std::unique_ptr<gpu::Device> device;
    RendererPtr renderer;
};

/// Fails if the device cannot render an image of that size.
[[nodiscard]] Status check_image_size(const gpu::Device& device, const IVec2& size);

/// Fails without OpenGL 4.5 or with a shader compiler's message. Default profile: chosen by the
/// device. `renderer`: the name of a RenderProfile; empty: that of `settings`, or the first that
/// the device can run.
[[nodiscard]] Result<HeadlessRenderer> create_headless_renderer(
    std::optional<gpu::Profile> profile = {}, const RenderSettings& settings = {},
    std::string_view renderer = {});

/// Compiles what the world needs (warm_up, render_frame.h), for images of this size; on a terminal,
/// with a progress line. Returns the number of programs.
int warm_up_world(HeadlessRenderer& headless, const World& world, Entity camera, const IVec2& size);

}  // namespace limn
