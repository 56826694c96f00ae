#include "content/app/commands/view_command.h"

#include "content/app/commands/hdr_image.h"
#include "content/app/commands/headless.h"
#include "content/app/commands/image_notes.h"
#include "content/app/player/image_viewer.h"
#include "content/app/player/window.h"
#include "content/game/game.h"
#include "content/load/files/exr_file.h"
#include "content/load/files/png_file.h"
#include "content/load/level/component_json.h"
#include "content/load/level/set_value.h"
#include "ecs/base/text.h"
#include "ecs/world.h"
#include "render/gpu/readback.h"

#include <fmt/format.h>

#include <fstream>
#include <ios>

// Techniques: hdr.viewer

namespace limn {
namespace {

/// The settings have been checked by the parser.
Exposure shown_exposure(const ViewOptions& options) {
    Exposure exposure = exposure_of_file(options.file);
    for (const auto& [field, value] : options.settings) {
        static_cast<void>(set_exposure(exposure, field, value));
    }
    return exposure;
}

Status view_headless(const ViewOptions& options) {
    const Result<std::unique_ptr<gpu::Context>> context = gpu::create_headless_context();
    if (!context) {
        return context.error();
    }
    const Result<std::unique_ptr<gpu::Device>> device = gpu::Device::from_current_context();
    if (!device) {
        return device.error();
    }
    const Result<std::unique_ptr<HdrImage>> hdr = HdrImage::load(**device, options.file);
    if (!hdr) {
        return hdr.error();
    }
    fmt::print("{}", describe(**hdr));
    const gpu::Texture& display = (*hdr)->show(shown_exposure(options));
    fmt::print("clipped {:.2f} % of the pixels\n", 100.0 * clipped_fraction(display));
    if (options.out.empty()) {
        return Done{};
    }
    const gpu::ByteImage image = gpu::read_bytes(display);
    return write_png(options.out, image.width, image.height, image.channels, image.pixels);
}

}  // namespace

Status set_exposure(Exposure& exposure, std::string_view field, std::string_view value) {
    register_game_components();
    World world;
    world.insert_resource(exposure);
    const Status status = set_value(world, "exposure." + std::string(field), value);
    if (!status) {
        // Without the prefix that names the option: "--set exposure.ev: found ..."
        const std::string& message = status.error().message;
        const std::size_t found = message.find(": ");
        return Error{found == std::string::npos ? message : message.substr(found + 2)};
    }
    exposure = world.resource<Exposure>();
    return Done{};
}

Exposure exposure_of_file(const std::string& path) {
    Exposure exposure;
    std::ifstream file(path, std::ios::binary);
    char first[2] = {};
    file.read(first, sizeof(first));
    const std::string_view magic(first, sizeof(first));
    if (magic != "\x76\x2f"
        && magic != "#?") {  // neither OpenEXR nor Radiance: tone mapped already
        return {.curve = ToneCurve::Linear, .dither = false};
    }
    for (const auto& [name, text] : read_exr_metadata(path)) {
        if (name != kExposureNote) {
            continue;
        }
        const Result<JsonValue> json = parse_json(text, path);
        if (json
            && read_component(*json, component_info<Exposure>(), &exposure, {path, name}, {})) {
            return exposure;
        }
    }
    return {.curve = ToneCurve::Knee};
}

Status run_view(const ViewOptions& options) {
    if (!options.out.empty()) {
        return view_headless(options);
    }
    if (!Window::has_display()) {
        LIMN_TRY(view_headless(options));
        fmt::print("There is no display, so no window is opened. -o FILE.png writes the image.\n");
        return Done{};
    }
    Result<std::unique_ptr<ImageViewer>> viewer =
        ImageViewer::open(options.file, shown_exposure(options), options.size);
    return viewer ? (*viewer)->run() : Status(viewer.error());
}

}  // namespace limn
