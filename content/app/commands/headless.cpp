#include "content/app/commands/headless.h"

#include "content/app/commands/progress.h"
#include "ecs/base/text.h"
#include "render/render_profile.h"
#include "render/render_view.h"

#include <utility>

namespace limn {

Status check_image_size(const gpu::Device& device, const IVec2& size) {
    const int limit = device.caps().max_texture_size;
    if (size.x > limit || size.y > limit) {
        return fail(
            "--size: found {}x{}, expected at most {} per side, the limit of {}", size.x, size.y,
            limit, device.caps().renderer);
    }
    return Done{};
}

Result<HeadlessRenderer> create_headless_renderer(
    std::optional<gpu::Profile> profile, const RenderSettings& settings,
    std::string_view renderer) {
    HeadlessRenderer headless;
    Result<std::unique_ptr<gpu::Context>> context = gpu::create_headless_context();
    if (!context) {
        return context.error();
    }
    headless.context = *std::move(context);
    Result<std::unique_ptr<gpu::Device>> device = gpu::Device::from_current_context(profile);
    if (!device) {
        return device.error();
    }
    headless.device = *std::move(device);
    RenderSettings chosen = settings;
    if (chosen.image.empty() || !renderer.empty()) {
        chosen.image = LIMN_TRY(find_profile(headless.device->caps(), renderer))->image();
    }
    headless.renderer = LIMN_TRY(create_renderer(*headless.device, chosen));
    return headless;
}

int warm_up_world(
    HeadlessRenderer& headless, const World& world, Entity camera, const IVec2& size) {
    std::optional<Progress> progress;
    const RenderView view = make_render_view(world, camera, {.width = size.x, .height = size.y});
    return warm_up(*headless.renderer, world, view, [&progress](int done, int total) {
        if (!progress) {
            progress.emplace("compiling shaders, view", total);
        }
        progress->update(done);
    });
}

}  // namespace limn
