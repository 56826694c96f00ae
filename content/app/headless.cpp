#include "content/app/headless.h"

#include <utility>

namespace limn {

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
