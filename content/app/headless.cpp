#include "content/app/headless.h"

#include "ecs/base/text.h"

#include <utility>

namespace limn {

Status check_picture_size(const gpu::Device& device, const IVec2& size) {
    const int most = device.caps().max_texture_size;
    if (size.x > most || size.y > most) {
        return fail(
            "--size: found {}x{}, expected at most {} a side: {} can draw no more", size.x, size.y,
            most, device.caps().renderer);
    }
    return Done{};
}

Result<HeadlessRenderer> create_headless_renderer() {
    HeadlessRenderer headless;
    Result<std::unique_ptr<gpu::Context>> context = gpu::create_headless_context();
    if (!context) {
        return context.error();
    }
    headless.context = *std::move(context);
    Result<std::unique_ptr<gpu::Device>> device = gpu::Device::from_current_context();
    if (!device) {
        return device.error();
    }
    headless.device = *std::move(device);
    Result<RendererPtr> renderer = create_renderer(*headless.device);
    if (!renderer) {
        return renderer.error();
    }
    headless.renderer = *std::move(renderer);
    return headless;
}

}  // namespace limn
