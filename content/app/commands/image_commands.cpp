#include "content/app/commands/image_commands.h"

#include "content/app/commands/command_options.h"
#include "ecs/components/post.h"

#include <string>

namespace limn {
namespace {

void add_film(CLI::App& app, FilmSettings& film) {
    add_integer(
        app, "--quality", "of a film, 0 (smallest file) to 100 (no visible loss)", film.quality, 0,
        100)
        ->default_str("85");
    app.add_option("--sound", film.sound, "sound of a film, cut or padded to its length")
        ->type_name("FILE");
}

}  // namespace

void add_render_options(CLI::App& app, RenderOptions& options) {
    app.add_option("scene", options.scene, kSceneDoc)->type_name("SCENE");
    add_size(app, options.size);
    add_number(app, "--fps", "frame n of --frames is at time n / fps", options.fps, 0.001, 10000)
        ->default_str("60");
    add_seed(app, options.seed);
    add_integer(
        app, "--spp",
        "samples per pixel, over lens and shutter, for final images; default: real-time effects",
        options.samples, 1, 65536);
    add_parsed(
        app, "--average",
        "mean of the samples: of the light, as a camera collects it (default with --spp and for "
        "EXR), or as displayed, which has smooth edges of lamps (default otherwise)",
        options.average, parse_average)
        ->type_name("light|displayed");
    add_parsed(app, "--aov", "layers to add to an EXR", options.aovs, parse_list)->type_name("A,B");
    add_show(app, options.show.technique);
    app.add_flag("--off", options.show.off, "with --show: without the technique");
    add_assignments(app, options.assignments);
    add_model_view(app, options.model);
    add_profile(app, options.profile, options.renderer);
    app.add_option("--camera", options.camera, "name of a camera; default: the level's active one")
        ->type_name("NAME");
    add_film(app, options.film);
}

Command add_render(CLI::App& program, RenderOptions& options) {
    CLI::App* app = program.add_subcommand("render", "Render an image or a range of frames");
    add_render_options(*app, options);
    app->add_option(
           "-o,--out", options.out,
           "OUT.png, OUT.exr; for --frames frame_%04d.png, or a film: OUT.mp4, .webm, .mkv, .gif")
        ->type_name("FILE")
        ->required();
    CLI::Option* time = add_number(
        *app, "--time",
        "simulation time of the image [s]; the simulation starts at 0; default: the show's, or 0",
        options.time, 0, 86400);
    add_parsed(
        *app, "--frames", "first and last frame, inclusive", options.frames, parse_frame_range)
        ->type_name("A:B")
        ->excludes(time);
    app->add_flag("--keep-frames", options.keep_frames, "keep the images of a film in OUT.frames");
    app->add_flag("--quiet", options.quiet, "print nothing but errors and warnings");
    app->footer(
        "Layers of --aov: depth [m], normal (world), albedo, velocity [pixels], emission,\n"
        "shadow_texels (shadow map texels per pixel), volume_layers (of shadow volumes).\n"
        "An EXR holds linear radiance, a PNG the tone-mapped image.\n"
        "PATH of --set is ENTITY.COMPONENT.FIELD, RESOURCE.FIELD or materials.NAME.FIELD.\n"
        "A name may contain dots, as in glTF files; the longest match is used.\n"
        "VALUE is JSON or a bare word: '[1, 2, 3]', 40deg, orange.\n"
        "Files are written under a temporary name and renamed when complete.\n"
        "A film needs the program ffmpeg. Its frames are images in OUT.frames until it is made; a\n"
        "film that was stopped goes on where it was.\n\n"
        "Examples:\n"
        "  limn render gallery -o gallery.png --size 1920x1080 --time 2\n"
        "  limn render helmet.glb -o helmet.exr --aov depth,normal\n"
        "  limn render helmet.glb -o 'turn_%04d.png' --frames 0:119 --turntable 2\n"
        "  limn render gallery -o 'frame_%04d.png' --frames 0:99 --fps 30\n"
        "  limn render gallery -o gallery.mp4 --frames 0:299 --fps 30\n"
        "  limn render --show water.fresnel --off -o without.png\n"
        "  limn render gallery -o dark.png --set exposure.ev=-2 --set "
        "materials.gilt.roughness=0.4");
    app->callback([&options] {
        if (const Status status = check_render_options(options); !status) {
            throw CLI::ValidationError(status.error().message);
        }
    });
    return {app, [&options] { return run_render(options); }};
}

Command add_film_command(CLI::App& program, FilmOptions& options) {
    CLI::App* app = program.add_subcommand("film", "Make a film of numbered images");
    app->add_option("images", options.frames, "frame_%04d.png or .exr")
        ->type_name("FILES")
        ->required();
    app->add_option("-o,--out", options.out, "OUT.mp4, OUT.webm, OUT.mkv or OUT.gif")
        ->type_name("FILE")
        ->required();
    add_parsed(
        *app, "--frames", "first and last frame, inclusive; default: all", options.range,
        parse_frame_range)
        ->type_name("A:B");
    add_number(*app, "--fps", "frames per second", options.film.fps, 0.001, 10000)
        ->default_str("60");
    add_film(*app, options.film);
    app->add_flag("--quiet", options.quiet, "print nothing but errors and warnings");
    app->footer("By the program ffmpeg: H.264 in .mp4 and .mkv, VP9 in .webm. Colors are BT.709 in "
                "limited\n"
                "range. An EXR is tone mapped as `limn view` does. No frame between the first and "
                "the last\n"
                "may be missing, and all have one size; odd sizes get a column or row more.\n\n"
                "Examples:\n"
                "  limn film 'frame_%04d.png' -o film.mp4 --fps 30\n"
                "  limn film 'frame_%04d.exr' -o film.webm --sound hello.wav");
    app->callback([&options] {
        if (const Status status = check_film_options(options); !status) {
            throw CLI::ValidationError(status.error().message);
        }
    });
    return {app, [&options] { return run_film(options); }};
}

Command add_view(CLI::App& program, ViewOptions& options) {
    CLI::App* app =
        program.add_subcommand("view", "Show an image; tone map an HDR image, interactively");
    app->add_option("file", options.file, ".exr, .hdr, .png, .jpg ...")
        ->type_name("FILE")
        ->required();
    add_parsed(*app, "-o,--out", "write the image, without a window", options.out, parse_png_path)
        ->type_name("FILE.png");
    add_size(*app, options.size)->description("of the window");
    struct Field {
        const char* name;
        const char* doc;
    };
    // Fields of the resource exposure; ranges and defaults are the same except for the curve.
    constexpr Field kFields[] = {
        {"curve", "neutral, aces, linear, reinhard, local or knee; default: the image's, or knee"},
        {"metering", "manual, or key: from the log-average luminance"},
        {"ev", "exposure compensation [stops]"},
        {"key", "log-average luminance after metering; default: 0.18"},
        {"defog", "fraction of the mean color subtracted, 0 to 0.01"},
        {"contrast", "contrast of knee; 0 = none"},
        {"white", "white point of reinhard (luminance); 0 = none"},
        {"encoding", "srgb or power; knee always uses power"},
        {"gamma", "gamma of power and knee; default: 2.2"},
        {"dither", "true or false"}};
    for (const Field& field : kFields) {
        const std::string name = std::string("--") + field.name;
        app->add_option_function<std::string>(
               name,
               [&options, field, name](const std::string& value) {
                   Exposure checked;
                   const Status status = set_exposure(checked, field.name, value);
                   if (!status) {
                       throw CLI::ValidationError(name, status.error().message);
                   }
                   options.settings.emplace_back(field.name, value);
               },
               field.doc)
            ->type_name("X");
    }
    app->footer(
        "An EXR of `limn render` is shown with the exposure of its scene, as the PNG would be;\n"
        "an image of 8 bits as it is.\n"
        "Prints log-average luminance, mean color and dynamic range. Pixels with NaN or infinity\n"
        "are counted, excluded from the statistics and shown black or white.\n"
        "Knee is 0.3333 (ln(contrast c + 1) / contrast)^(1 / gamma) with c = 2^ev (light - "
        "defog).\n"
        "In the window, Up and Down change the exposure, C the curve; F9 saves the image.\n\n"
        "Examples:\n"
        "  limn view memorial.exr\n"
        "  limn view memorial.exr -o shown.png --ev 3 --defog 0.005 --contrast 1\n"
        "  limn view memorial.exr -o shown.png --curve local --metering key");
    return {app, [&options] { return run_view(options); }};
}

}  // namespace limn
