#include "content/app/commands/command_line.h"

#include "content/app/bench/bench_command.h"
#include "content/app/commands/bake_command.h"
#include "content/app/commands/check_command.h"
#include "content/app/commands/command_entry.h"
#include "content/app/commands/command_options.h"
#include "content/app/commands/compare_command.h"
#include "content/app/commands/edit_command.h"
#include "content/app/commands/hash_command.h"
#include "content/app/commands/head_scene.h"
#include "content/app/commands/image_commands.h"
#include "content/app/commands/image_file.h"
#include "content/app/commands/import_command.h"
#include "content/app/commands/info_command.h"
#include "content/app/commands/list_commands.h"
#include "content/app/commands/log_sink.h"
#include "content/app/commands/make_command.h"
#include "content/app/commands/shows_command.h"
#include "content/app/commands/sibling_program.h"
#include "content/app/commands/speak_command.h"
#include "content/app/farm/farm_command.h"
#include "content/app/player/play_command.h"
#include "content/make/find_kind.h"
#include "ecs/base/type_name.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace limn {
namespace {

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kWrongUsage = 2;

Command add_play(CLI::App& program, PlayOptions& options) {
    CLI::App* app = program.add_subcommand("play", "Play a level in a window");
    app->add_option("scene", options.scene, std::string(kSceneDoc) + "; default: gallery")
        ->type_name("SCENE");
    add_size(*app, options.size)->description("of the window");
    app->add_flag("--fullscreen", options.fullscreen, "full screen");
    app->add_option_function<std::string>(
           "--scale",
           [&options](const std::string& text) {
               options.scale_auto = text == "auto";
               if (options.scale_auto) {
                   return;
               }
               const Result<double> scale = parse_number(text, 0.1, 2.0);
               if (!scale) {
                   throw CLI::ValidationError("--scale", scale.error().message + ", or auto");
               }
               options.scale = static_cast<float>(*scale);
           },
           "rendered pixels per window pixel, 0.1 to 2; auto adapts it to hold 60 frames per "
           "second, or 16 without a GPU, where it is the default")
        ->type_name("auto|X");
    app->add_option_function<std::string>(
           "--antialiasing",
           [&options](const std::string& text) {
               if (text != "none" && text != "temporal") {
                   throw CLI::ValidationError(
                       "--antialiasing", fmt::format("found {}, expected none or temporal", text));
               }
               options.antialiasing = text == "none" ? Antialiasing::None : Antialiasing::Temporal;
           },
           "instead of the level's own; default: temporal")
        ->type_name("none|temporal");
    add_show(*app, options.show);
    add_model_view(*app, options.model);
    add_profile(*app, options.profile, options.renderer);
    CLI::Option* const markers =
        app->add_option(
               "--markers", options.markers,
               "place the markers of this recording on the face by clicking, see limn import")
            ->type_name("TAKE.trc");
    app->add_option("--map", options.map, "file of their places; default: TAKE.map")
        ->type_name("FILE")
        ->needs(markers);
    add_integer(
        *app, "--headless-frames", "render N frames along the camera path, without a window",
        options.headless_frames, 1, 10000);
    app->add_option("-o,--out", options.out, "folder for frames and screenshots")
        ->type_name("FOLDER");
    app->footer(
        "Without a display, renders frames along the camera path and prints where they are.\n"
        "F1 in the window lists the keys.\n\n"
        "Examples:\n"
        "  limn play\n"
        "  limn play gallery --size 1920x1080 --scale auto\n"
        "  limn play model.glb --backdrop sky\n"
        "  limn play --show water.fresnel\n"
        "  limn play face.glb --markers take.trc\n"
        "  limn play gallery --headless-frames 12 -o frames");
    return {app, [&options] { return run_play(options); }};
}

Command add_bench(CLI::App& program, BenchOptions& options) {
    CLI::App* app =
        program.add_subcommand("bench", "Measure systems, passes and frames of a scene");
    app->add_option("scene", options.scene, kSceneDoc)->type_name("SCENE")->required();
    add_integer(*app, "--frames", "frames to measure", options.frames, 1, kMaxFrames)
        ->default_str(std::to_string(options.frames));
    add_integer(*app, "--warmup", "frames run first, not measured", options.warmup, 0, kMaxFrames)
        ->default_str(std::to_string(options.warmup));
    add_size(*app, options.size);
    add_assignments(*app, options.assignments);
    add_profile(*app, options.profile, options.renderer);
    app->add_option("--json", options.json, "write the numbers as JSON; - is stdout")
        ->type_name("FILE");
    app->add_option("--csv", options.csv, "write the numbers as CSV; - is stdout")
        ->type_name("FILE");
    app->add_option(
           "--svg", options.svg, "`particles` and `faces` only: plot the cost over their number")
        ->type_name("FILE");
    app->add_option(
           "--only", options.only, "`particles`, `faces`, `characters` only: measure one part")
        ->type_name("PART");
    app->add_flag(
        "--targets", options.targets,
        "also list what each pass reads and writes, and the render targets with their formats");
    app->add_flag(
        "--bottleneck", options.bottleneck,
        "also measure what the frame waits for: application, geometry or rasterization");
    add_integer(
        *app, "--most",
        "`particles` only: how many at the last point of the curves; default: 10000000",
        options.most, 1000, 100'000'000);
    app->callback([&options] {
        if (const Status fits = check_bench_options(options); !fits) {
            throw CLI::ValidationError(fits.error().message);
        }
    });
    app->footer(
        R"(Every frame simulates one step and renders off screen; a level has detail for the size of the image, as `limn
play` chooses them (`--set rendering.level_rows=1080`: as `limn render`). Times are in milliseconds;
"all threads" is CPU time, which depends less on other programs. Shaders are compiled before the first frame
("compile_ms"); "compiled" counts those that a measured frame had to compile.

JSON: {"scene", "size": [w, h], "frames", "warmup", "threads", "gl": {"renderer", "version"},
"memory": {"resident_begin_mib", "resident_mib", "heap_begin_mib", "heap_mib", "gpu_mib"},
"counts": {"entities", "boxes_tested", "instances", "draws", "triangles", "programs", "compiled"}, "compile_ms",
with --bottleneck "stages": {"application_ms", "geometry_ms", "rasterization_ms"}, and arrays
"frame", "systems", "passes" of {"name", "clock": "cpu" or "gpu", "median_ms", "p95_ms", "max_ms"},
"traffic" of {"pass", "read_mib", "written_mib"}, if each texel is read and written once, and
"targets" of {"name", "format", "bytes_per_pixel", "size", "mib"}}
CSV: kind,name,clock,median_ms,p95_ms,max_ms

The scene `lights` is measured with 16, 64 ... 4096 lights, with every method of rendering.lights,
each for at most --frames frames or a few seconds; a method stops where a frame would take longer
than 12 s. JSON: {"scene", "size", "threads", "gl", "methods": [{"name", "points": [{"lights",
"frames", "median_ms", "p95_ms", "max_ms", "passes"} or {"lights", "left_out"}]}],
"full_screen_over_clustered": [{"lights", "ratio"}]}
CSV: method,lights,frames,median_ms,p95_ms,max_ms

`limn bench lens` measures the level `stilllife` without lens effects, with each alone, and with
ripple, motion blur, depth of field and glow together. "added" is the increase over a frame without
effects, "passes" the sum of the passes that such a frame lacks.
JSON: {"scene", "size", "frames", "warmup", "threads", "gl", "points": [{"effects", "median_ms",
"p95_ms", "added_ms", "passes_ms", "passes"}]}
CSV: effects,frames,median_ms,p95_ms,added_ms,passes_ms

`limn bench surfaces` draws one wall of the level `temple` with each material.detail, from flat to
silhouette. "ratio" is the frame's CPU time to that of the flat wall.
JSON: {"scene", "size", "frames", "warmup", "threads", "gl", "points": [{"detail", "median_ms",
"gbuffer_ms", "ratio"}]}
CSV: detail,frames,median_ms,gbuffer_ms,ratio

`limn bench forms` draws a ball by the cheaper forms of a shader that the book's chapter 11 advises, each
beside the plain form: matrices multiplied on the CPU, the vector to the light per vertex, one
normalization to tangent space, acos from a table. "shade" and "angle" are the largest
differences of the diffuse share and of angles [rad] in the image; the best of --frames counts.
JSON: {"size", "frames", "threads", "gl", "points": [{"form", "ms", "plain_ms", "ratio", "shade", "angle"}]}
CSV: form,ms,plain_ms,ratio,shade,angle

`limn bench tables` looks up names in the hash tables of the book's chapter 11 and in
std::unordered_map, --frames times each; the best counts. "compared" is keys per lookup, "time" a
ratio to std::unordered_map.
JSON: {"zoo": [{"step", "longest", "total", "slots"}], "points": [{"table", "names", "longest",
"compared", "ratio"}]}
CSV: table,names,longest,compared,ratio

`limn bench fakephong` draws each model of the level `phonglab` under 1, 4 and 16 lights by every
method of rendering.shading, alternating, --frames times each; the best counts. Beside these times
are the operations that the methods take on a CPU: lighting evaluations per facet, the rest per pixel,
and the work of a frame relative to Phong shading.
JSON: {"scene", "size", "frames", "threads", "gl", "points": [{"model", "lights",
"methods": [{"shading", "best_ms", "ratio"}]}], "counts": [{"model", "method", "lightings",
"additions", "multiplications", "divisions", "roots", "powers", "fetches", "work"}]}
CSV: model,lights,shading,frames,best_ms,ratio and, after an empty line,
model,method,lightings,additions,multiplications,divisions,roots,powers,fetches,work

`limn bench particles` checks particles against their gates, ratios to hand-written loops,
and shows the cost per particle for a thousand to ten million. It draws nothing; each runs at most
--frames times, and the best counts. --only update, sort, collision, world, draw or growth
measures that part.
JSON: {"threads", "gates": [{"gate", "name", "ours", "other", "against", "unit", "ratio", "limit",
"met"}], "growth": [{"curve", "points": [{"count", "ns"}]}], "notes"}
CSV: gate,name,ours,other,unit,ratio,limit,met and, after an empty line, curve,count,ns

`limn bench faces` deforms a hundred heads and measures the compression of their skin, beside
scalar versions, draws wrinkled skin beside plain PBR, and shows the cost per face for 1 to 100.
Each runs at most --frames times, and the best counts.
JSON: {"threads", "rows": [{"name", "ours_ms", "reference_ms", "against", "ratio", "limit", "met"}],
"growth": [{"curve", "faces", "ns"}]}
CSV: name,ours_ms,reference_ms,against,ratio,limit,met and, after an empty line, curve,faces,ns

`limn bench characters` poses crowds of up to 10,000 characters next to plain scalar loops and a copy
of what they write: sampling of compressed clips, blending, joint matrices, skins. Each runs 9 to
--frames times, in turns, and the best counts. "ratio" is ours / reference, "limit" its gate, "peer" that
of the best other library where it was measured. --only measures one part.
JSON: {"threads", "vector_floats", "rows": [{"gate", "name", "ours", "reference", "against", "unit",
"ratio", "limit", "stretch", "peer", "met"}], "notes"}
CSV: gate,name,ours,reference,against,unit,ratio,limit,stretch,peer,met

Examples:
  limn bench lights --size 640x360
  limn bench lens --size 640x360 --frames 100
  limn bench fakephong --size 640x360 --frames 9
  limn bench surfaces --size 640x360 --frames 40
  limn bench forms --size 640x360 --frames 40
  limn bench gallery --size 640x360 --set glow.strength=0.1
  limn bench gallery --size 320x180 --frames 30 --bottleneck
  limn bench museum --frames 10 --targets
  limn bench stress-instances --frames 600 --json numbers.json
  limn bench particles --csv particles.csv --svg particles.svg
  limn bench particles --only growth --most 100000
  limn bench faces --csv faces.csv --svg faces.svg
  limn bench characters --only chain)");
    return {app, [&options] { return run_bench(options); }};
}

Command add_hash(CLI::App& program, HashOptions& options) {
    CLI::App* app = program.add_subcommand("hash", "Print a hash of the state after every step");
    app->add_option("scene", options.scene, kSceneDoc)->type_name("SCENE")->required();
    add_integer(*app, "--frames", "steps to run", options.frames, 1, kMaxFrames)->required();
    add_integer(
        *app, "--threads", "threads to use; default: all hardware threads", options.threads, 1,
        256);
    add_seed(*app, options.seed);
    app->footer("Prints one line per step: frame number, then 16 hex digits. The hashes are the "
                "same in every\n"
                "run and for every number of threads.\n\n"
                "Example:\n"
                "  limn hash stress-instances --frames 600 --threads 2");
    return {app, [&options] { return run_hash(options); }};
}

Command add_check(CLI::App& program, std::string& scene) {
    CLI::App* app = program.add_subcommand("check", "Check a level: load, step, draw, warn");
    app->add_option("scene", scene, kSceneDoc)->type_name("SCENE")->required();
    app->footer("Prints what is wrong or has no effect, such as all bad parts of a model; exits "
                "with status 1\n"
                "if there is an error.\n\n"
                "Example:\n"
                "  limn check my.level.json");
    return {app, [&scene] { return run_check(scene); }};
}

Command add_edit(CLI::App& program, EditOptions& options) {
    CLI::App* app = program.add_subcommand("edit", "Edit a level as the inspector does");
    app->add_option("level", options.scene, "level name or .level.json")
        ->type_name("LEVEL")
        ->required();
    app->add_option("edits", options.lines, "edits, each as one word")->type_name("EDIT");
    app->add_option("--script", options.script, "a file with an edit per line; # begins a comment")
        ->type_name("FILE");
    app->add_option("-o", options.out, "the edited level; default: prints what would change")
        ->type_name("FILE");
    app->footer("An EDIT is one of\n"
                "  set PATH = VALUE   as --set of `limn render`\n"
                "  add NAME.COMPONENT, remove NAME.COMPONENT\n"
                "  cut NAME, copy NAME, paste [PARENT], duplicate NAME, delete NAME\n"
                "  place PREFAB (at the origin), undo, redo\n"
                "where NAME and PARENT are entities. Whole entities take their children with them; "
                "cut and\n"
                "paste keep the world transform. An edit that fails ends the command, and nothing "
                "is written.\n"
                "FILE is a new one in the level's folder if the level refers to files there; the "
                "comments of\n"
                "the level's file are not kept.\n\n"
                "Examples:\n"
                "  limn edit pond \"set sun.transform.rotation = [215, -20, 0]\"\n"
                "  limn edit pond \"duplicate pool\" \"delete pool\" undo -o my.level.json\n"
                "  limn edit den \"place fox\" \"set fox.name.text = vixen\" -o my.level.json\n"
                "  limn edit pond --script arrange.txt -o my.level.json");
    return {app, [&options] { return run_edit(options); }};
}

Command add_quality(CLI::App& program) {
    CLI::App* app = program.add_subcommand("quality", "Compare the effects with their oracles");
    app->set_help_flag();  // all further arguments, including --help, are for the other program
    app->prefix_command();
    return {app, [app] { return run_sibling("limn quality", "limn-quality", app->remaining()); }};
}

Command add_compare(CLI::App& program, CompareOptions& options) {
    CLI::App* app = program.add_subcommand("compare", "Compare two images");
    app->add_option("a", options.a, "reference image")->type_name("A")->required();
    app->add_option("b", options.b, "image to compare, of the same size")
        ->type_name("B")
        ->required();
    app->add_flag("--json", options.json, "print JSON");
    add_parsed(*app, "--diff", "write a difference image", options.diff, parse_png_path)
        ->type_name("FILE.png");
    app->footer(
        "Prints PSNR [dB], SSIM, FLIP (mean and 99th percentile), the largest difference in a\n"
        "channel, color correctness and the scanline through A's brightest pixel; for two EXR "
        "files also\n"
        "the relative mean square error. --diff raises differences to the power 1/10: one step of\n"
        "255 shows as 57 % gray. In JSON, \"psnr\" is null for equal images.\n\n"
        "Example:\n"
        "  limn compare before.png after.png --diff difference.png");
    return {app, [&options] { return run_compare(options); }};
}

Command add_bake(CLI::App& program, BakeOptions& options) {
    CLI::App* app = program.add_subcommand(
        "bake", "Make maps from meshes, heights or photographs, and clips of motion");
    std::string kinds;
    for (const BakeKind& kind : bake_kinds()) {
        kinds += fmt::format("  {:<12} {}\n", kind.name, kind.doc);
    }
    add_parsed(
        *app, "kind", "of maps or motion", options.kind,
        [](const std::string& text) {
            return find_kind(bake_kinds(), text) != nullptr
                       ? Result<std::string>(text)
                       : Error{fmt::format(
                           "found \"{}\", expected {}{}", text, kind_names(bake_kinds()),
                           kind_suggestion(bake_kinds(), text))};
        })
        ->type_name("KIND")
        ->required();
    app->add_option(
           "in", options.in,
           ".gltf, .glb or .obj; or an image of heights; .json for photometric and strain_model; "
           ".bvh, .htr, .trc or .glb for motion and retarget; for walk a file with a skeleton, or "
           "person")
        ->type_name("IN")
        ->required();
    app->add_option("body", options.body, "retarget, and motion of .trc: a file with a skeleton")
        ->type_name("BODY");
    add_parsed(
        *app, "-o,--out",
        "NAME.png or NAME.exr; NAME.dds of block; NAME.glb, NAME.bvh or NAME.svg of motion",
        options.out,
        [](const std::string& text) {
            for (const char* const ending : {".glb", ".bvh", ".svg", ".dds"}) {
                if (text.ends_with(ending)) {
                    return Result<std::string>(text);
                }
            }
            const Result<ImageFileKind> kind = image_file_kind(text);
            return kind ? Result<std::string>(text) : kind.error();
        })
        ->type_name("FILE")
        ->required();
    app->add_option("--recipe", options.recipe, "settings of the kind")->type_name("FILE.json");
    app->add_option(
           "--mesh", options.mesh,
           "name of the mesh; default: all of the file, for furrows the largest")
        ->type_name("NAME");
    app->add_option("--high", options.high, "detail: the mesh with the details")->type_name("FILE");
    app->add_flag("--gpu", options.gpu, "compute the same maps on the GPU");
    add_assignments(*app, options.assignments);
    app->footer(fmt::format(
        "KIND is one of\n{}\n"
        "PATH of --set is a field of the recipe, VALUE is JSON or a bare word.\n"
        "normal, relief, cone, ao and odd take an image of heights (white is high; PNG with 8 or "
        "16 "
        "bits, EXR\n"
        "...) or a mesh, which is seen through a side of its box (--set face=front), as does "
        "double-depth.\n"
        "Their recipe: size (of the map of a mesh), face, depth, repeats, samples, rays, reach, "
        "order, bits,\n"
        "levels; that of detail: size, samples, distance, padding, object_space, rays, reach, "
        "bits.\n"
        "Relief maps have the normal's x and y in red and green, green up, and the depth in alpha; "
        "blue is the\n"
        "normal's z, the cone's ratio or the depth of the back. They are the relief_texture of a "
        "material:\n"
        "  \"images\": {{\"wall\": {{\"file\": \"wall.png\", \"srgb\": false}}}},\n"
        "  \"materials\": {{\"wall\": {{\"detail\": \"relief\", \"relief_texture\": "
        "{{\"image\": \"wall\"}}}}}}\n"
        "atlas takes a model and writes it with materials that differ only in their textures as "
        "one,\n"
        "whose textures are cells of one image. Its recipe: max_size (of an image), gutter (around "
        "each\n"
        "texture, in pixels of a cell of 512). A material that tiles its texture keeps it; "
        "cameras,\n"
        "lights and variants are left out.\n"
        "block takes an image of 8 bits and writes blocks with mip levels. Its recipe: kind "
        "(color, normal,\n"
        "data), format (bc5 of normals, else bc7), levels.\n"
        "detail writes NAME_normal, NAME_height and NAME_occlusion of the mesh --high for the "
        "texture\n"
        "coordinates of IN, and NAME.glb, which is IN with these maps; with --set relief=true "
        "also\n"
        "NAME_relief, and the outline of NAME.glb is that of --high.\n"
        "furrows writes NAME_height.png, 16 bits gray, white is skin without a furrow, or\n"
        "NAME_height.exr with both fields apart as first.Y and second.Y; and NAME_normal.png, "
        "green up.\n"
        "Its recipe has the fields of the image kind furrows (limn components furrows), as\n"
        "  {{\"preset\": \"hand\", \"projection\": \"uv\", \"arrows\": [\n"
        "    {{\"at\": [0, 1, 0], \"first\": [0, 1, 0], \"second\": [1, 0, 0], \"weight\": 1}}]}}\n"
        "photometric reads a file that says\n"
        "  {{\"shots\": [{{\"image\": \"a.png\", \"to_light\": [1, 0, 1]}}, ...], \"shadow\": "
        "0.02}}\n"
        "of at least three photographs of a matte surface from one viewpoint, each lit by one of\n"
        "several equally bright lights, and writes NAME_normal.png and NAME_albedo.png.\n"
        "strain_model reads a file that says\n"
        "  {{\"face\": \"face.glb\", \"rest\": \"rest.png\", \"poses\": [\n"
        "    {{\"image\": \"smile.png\", \"shapes\": [{{\"name\": \"mouthSmile_L\"}}, ...]}}, "
        "...]}}\n"
        "with normal maps of facial expressions, and writes NAME.exr, the wrinkle texture of a\n"
        "wrinkle_surface with the method model.\n"
        "motion cleans up a recorded motion. Its recipe: clip, rate, cutoff [Hz, against noise],\n"
        "travel (moves a walk on the spot), loop, loop_min, loop_max, contacts, contact_speed,\n"
        "contact_height. Of markers, a .trc file, it makes the motion of BODY; the recipe says\n"
        "  {{\"markers\": [{{\"marker\": \"LASI\", \"joint\": \"Hips\", \"at\": [0.1, 1, 0.1]}}, "
        "...]}}\n"
        "with positions in the rest pose; swap_margin and max_gap are for labels and gaps.\n"
        "retarget gives a motion to BODY, whose joints have equal names or are the same parts of "
        "a\n"
        "person; planted feet stay. Its recipe: clip, pin_feet, fade, hands, travel.\n"
        "walk makes a walk for the legs of a skeleton; IN may be person, as limn make makes it. "
        "Its recipe:\n"
        "speed, stride, step_height, plateau, flight; knee_bend, stoop, width, toe_off, "
        "heel_strike; left,\n"
        "right (weights of hip, knee and ankle), limp, tiredness; hip_yaw, hip_roll, sway, bob; "
        "arm_swing,\n"
        "arms; pace, turn, points ([{{\"position\": [2, 0, 3], \"wait\": 1}}, ...]), standing, "
        "seconds,\n"
        "rate; cycle makes two steps that repeat, on the spot.\n"
        "ghosts superimposes the poses of a motion; its recipe: clip, begin, end, step [s], "
        "trails\n"
        "(names of joints), highlight. curves plots the rotation channels of the joint of its\n"
        "recipe over time.\n"
        "Files are written under a temporary name and renamed when complete.\n\n"
        "Examples:\n"
        "  limn bake ghosts walk.bvh -o ghosts.glb --set step=0.1 --set 'trails=[\"LeftFoot\"]'\n"
        "  limn bake curves walk.bvh -o knee.svg --set joint=LeftLeg\n"
        "  limn bake motion walk.bvh -o walk.glb --set cutoff=8 --set travel=true --set loop=true\n"
        "  limn bake motion walk.glb -o walk.bvh\n"
        "  limn bake retarget walk.bvh person.glb -o walking.glb\n"
        "  limn bake walk person -o walk.glb --set speed=1.1 --set limp=0.6 --set turn=0.3\n"
        "  limn bake normal heights.png -o normal.png --set depth=0.02\n"
        "  limn bake cone model.glb -o cones.png --set face=top --set size=64\n"
        "  limn bake detail low.obj --high high.obj -o statue.png --set distance=0.05\n"
        "  limn bake photometric shots.json -o face.png\n"
        "  limn bake atlas tiles.gltf -o tiles.glb\n"
        "  limn bake block wall.png -o wall.dds\n"
        "  limn bake strain_model poses.json -o wrinkles.exr\n"
        "  limn bake furrows model.glb -o skin.png --set projection=cylinder\n"
        "  limn bake furrows model.glb -o skin.exr --set projection=planar --set preset=hand",
        kinds));
    return {app, [&options] { return run_bake(options); }};
}

Command add_info(CLI::App& program, std::string& file) {
    CLI::App* app = program.add_subcommand(
        "info", "Print the contents of a file; for a scene, the number of shader programs, too");
    app->add_option("file", file, ".level.json, .gltf, .glb, .obj, .bvh, .trc, .png, .exr ...")
        ->type_name("FILE")
        ->required();
    app->footer(
        "For a .csv with answers of viewers to the level relax: their counts beside those of the "
        "original study.\n\nExample:\n  limn info model.glb");
    return {app, [&file] { return run_info(file); }};
}

Command add_import(CLI::App& program, ImportOptions& options) {
    CLI::App* app = program.add_subcommand("import", "Convert other formats to glTF");
    app->add_option(
           "kind", options.kind, "of the data: bvh, face-model, ict-facekit, makehuman or markers")
        ->type_name("KIND")
        ->required()
        ->check(CLI::IsMember({"bvh", "face-model", "ict-facekit", "makehuman", "markers"}));
    app->add_option(
           "in", options.in,
           "folder with the data, the .bvh file of motion, the .trc file of markers or the text of "
           "a "
           "face model")
        ->type_name("IN")
        ->required();
    app->add_option("-o,--out", options.out, "file to write")->type_name("FILE.glb")->required();
    app->add_flag(
        "--head", options.head,
        "markers only: they are named after those of the built-in head, see below");
    app->add_option("--onto", options.onto, "markers only: a face that performs the recording")
        ->type_name("FACE.glb");
    app->add_option("--map", options.map, "places of the markers on that face, see below")
        ->type_name("FILE");
    app->add_flag("--patches", options.patches, "write the markers on that face, not its shapes");
    app->add_option(
           "--library", options.library,
           "markers only: add the recording with its sound, for limn speak --fragments")
        ->type_name("FILE.json");
    app->add_option("--text", options.text, "what is said in the recording");
    app->add_option("--sound", options.sound, "of the recording; default: the .wav beside it")
        ->type_name("FILE.wav");
    app->add_option(
           "--labels", options.labels,
           "when it is said, lines of start, end [s] and word (or sound, from \"sil\" on), as "
           "Audacity\n"
           "exports them; default: found by pauses of the sound and changes of its spectrum")
        ->type_name("FILE.txt");
    add_assignments(*app, options.assignments, "--set", "bvh only: scale, up, rate or positions");
    app->footer(
        "bvh: recorded motion, as a skeleton with a clip and a figure of bones. Settings:\n"
        "scale [m per unit of the file; by default one that makes a person 1.65 m high],\n"
        "up [y, z; by default from the feet to the hips], rate [keys per second; by default those\n"
        "of the file], positions [add, replace: what channels of positions do to the offset].\n"
        "face-model: parameters that rotate, translate or scale weighted vertices of an OBJ mesh, "
        "as\n"
        "shapes. Lines of the file: mesh FILE.obj, unit METERS, parameter NAME, then one of\n"
        "rotate X Y Z by DEGREES about X Y Z, translate X Y Z, scale X Y Z about X Y Z, and any\n"
        "number of vertex NUMBER WEIGHT and ball X Y Z RADIUS.\n"
        "ict-facekit: the neutral face of ICT FaceKit with all expressions in its folder "
        "FaceXModel;\n"
        "where one half of an expression is missing, the other is mirrored.\n"
        "makehuman: the base mesh of MakeHuman with its expression units, the mean of the young\n"
        "builds, the default rig and eyes, from base.obj, targets, rigs and proxies.\n"
        "Shapes keep their names and have their FACS action units; skin has wrinkle regions\n"
        "with the direction across the folds.\n"
        "markers: recorded markers of a face, a TRC file whose first frame is the face at rest;\n"
        "those called head... remove the motion of the head, gaps are filled. A face follows by\n"
        "\"surface_binding\": {\"surface\": \"take\", \"method\": \"patches\"}, where the entity "
        "take\n"
        "has the file as its gltf. With --head, markers are named as in the mesh of the built-in\n"
        "head, part \"markers\": mouth9_90_M is on loop 9 of the mouth, at 90 degrees, on the\n"
        "midline; the recorded face may be another, and markers that it lacks follow their\n"
        "neighbors.\n"
        "With --onto, the recording is moved to another face by a warp through pairs of points:\n"
        "each marker's place is that of a line \"marker = x y z\" [m] or \"marker = place\" in the "
        "map,\n"
        "or follows from its name. Places are markers of the built-in head, or chin, jaw, mouth,\n"
        "upperlip, lowerlip, nose, nostril, cheek, browinner, browouter, forehead and so on, with\n"
        "L, R, left or right where there are two. limn play FACE.glb --markers TAKE.trc makes the\n"
        "map by clicking.\n\n"
        "Examples:\n"
        "  limn import bvh walk.bvh -o walk.glb --set scale=0.01 --set up=z\n"
        "  limn import ict-facekit ICT-FaceKit -o face.glb\n"
        "  limn import face-model face.txt -o face.glb\n"
        "  limn import makehuman makehuman -o person.glb\n"
        "  limn import markers take.trc -o take.glb\n"
        "  limn import markers take.trc --head -o take.glb\n"
        "  limn import markers take.trc --onto face.glb -o acted.glb\n"
        "  limn import markers take.trc -o take.glb --library said.json --text \"It is one.\"\n"
        "  limn play face.glb");
    return {app, [&options] { return run_import(options); }};
}

Command add_make(CLI::App& program, MakeOptions& options) {
    CLI::App* app = program.add_subcommand("make", "Write a generated mesh as glTF");
    app->add_option(
           "kind", options.kind, "of mesh, as \"make\" of a level: person, head, teapot ...")
        ->type_name("KIND")
        ->required();
    app->add_option("-o,--out", options.out, "file to write")->type_name("FILE.glb")->required();
    app->add_flag(
        "--parts", options.parts, "all parts that the kind has, each a mesh with its own material");
    add_assignments(
        *app, options.assignments, "--set",
        "a parameter of the kind; `limn components` lists them with ranges and defaults");
    app->footer("With skin, skeleton, clips and morph targets, where the kind has them. Kinds that "
                "are made\n"
                "of other meshes of a level are not written.\n\n"
                "Examples:\n"
                "  limn make person --set height=1.8 --set seed=7 -o person.glb\n"
                "  limn make person --parts --set hair=bun --set legs=skirt -o dressed.glb\n"
                "  limn make teapot -o teapot.glb\n"
                "  limn play person.glb");
    return {app, [&options] { return run_make(options); }};
}

Command add_export(CLI::App& program, ExportOptions& options) {
    CLI::App* app = program.add_subcommand("export", "Write the built-in head or a person as glTF");
    app->add_option(
           "name", options.name, "head; portrait: with hair; person: dressed, from head to toe")
        ->type_name("NAME")
        ->required()
        ->check(CLI::IsMember({"head", "portrait", "person"}));
    app->add_option("-o,--out", options.out, "file to write")->type_name("FILE.glb")->required();
    add_assignments(
        *app, options.assignments, "--set",
        "a parameter of the person; `limn components` lists them with ranges and defaults");
    app->footer("Skin, eyes, teeth and mouth, with skeleton and the shapes of its FACS action "
                "units, for\n"
                "limn speak, limn import markers --onto or other programs. A person has fewer "
                "shapes, clips\n"
                "of its body, and the materials of skin, hair and cloth.\n\n"
                "Examples:\n"
                "  limn export head -o head.glb\n"
                "  limn export person --set seed=7 --set hair=long -o person.glb\n"
                "  limn speak \"Hello!\" --face head.glb -o hello.glb");
    return {app, [&options] { return run_export(options); }};
}

Command add_speak(CLI::App& program, SpeakOptions& options) {
    CLI::App* app = program.add_subcommand("speak", "Make a face speak a text, with audio");
    app->add_option("text", options.text, "what it says, in English")->required();
    app->add_option(
           "--face", options.face,
           "face whose shapes have FACS action units, or head or portrait: the built-in head")
        ->type_name("FILE.glb")
        ->required();
    app->add_option("-o,--out", options.out, "file to write; sound goes beside it as .wav")
        ->type_name("FILE.glb")
        ->required();
    app->add_option("--voice", options.voice, "of espeak-ng (en, en-us, en-gb-scotland ...)")
        ->capture_default_str();
    add_assignments(
        *app, options.expression, "--express",
        "weight of a shape or action unit while speaking, as AU12=0.5");
    app->add_option(
           "--fragments", options.fragments,
           "use the motion and the sound of these recordings instead of rules")
        ->type_name("FILE.json");
    app->add_option("--map", options.map, "places of their markers on the face, as of limn import")
        ->type_name("FILE");
    app->add_option("--record", options.record, "add the utterance to these recordings")
        ->type_name("FILE.json");
    app->add_flag("--silent", options.silent, "pronounce by rules, without espeak-ng and audio");
    app->add_option("--seed", options.seed, "seed of blinks, gaze and head motion")
        ->capture_default_str();
    app->footer(
        "Writes a copy of the face with a new first clip: mouth, blinks, gaze, and the head if a\n"
        "node has that name. Phonemes and their timing come from espeak-ng; without it,\n"
        "from spelling rules and mean durations. Neighboring phonemes influence each other\n"
        "(dominance functions of Cohen and Massaro 1993).\n\n"
        "Examples:\n"
        "  limn import ict-facekit ICT-FaceKit -o face.glb\n"
        "  limn speak \"The time is exactly one.\" --face face.glb -o clock.glb\n"
        "  limn speak \"Hello!\" --face face.glb -o hello.glb --express AU12=0.4 --express "
        "AU2=0.5\n"
        "  limn play clock.glb");
    return {app, [&options] { return run_speak(options); }};
}

Command add_levels(CLI::App& program) {
    CLI::App* app = program.add_subcommand("levels", "List the levels");
    app->footer("Example:\n  limn levels");
    return {app, [] { return run_levels(); }};
}

Command add_shows(CLI::App& program, std::vector<std::string>& words) {
    CLI::App* app = program.add_subcommand(
        "shows", "Find a technique, and the level that shows it with and without");
    app->add_option(
           "words", words,
           "of its name or id: list what has them all, or print how to show the only one; "
           "default: list all")
        ->type_name("WORD");
    app->footer("Examples:\n"
                "  limn shows\n"
                "  limn shows depth of field\n"
                "  limn shows bloom\n"
                "  limn shows water.fresnel");
    return {app, [&words] { return run_shows(words); }};
}

struct ComponentsOptions {
    std::string name;
    bool schema = false;
    bool all = false;
};

Command add_components(CLI::App& program, ComponentsOptions& options) {
    CLI::App* app = program.add_subcommand(
        "components", "List what levels are made of, with fields, units, ranges and defaults");
    CLI::Option* name = app->add_option(
                               "name", options.name,
                               "of a component, resource, \"material\", \"path\", or what meshes "
                               "and images are made by; default: list all")
                            ->type_name("NAME");
    app->add_flag("--schema", options.schema, "print the JSON Schema of a level file instead")
        ->excludes(name);
    app->add_flag("--all", options.all, "include those that only systems use");
    app->footer("Examples:\n"
                "  limn components\n"
                "  limn components point_light\n"
                "  limn components --schema > level.schema.json");
    return {app, [&options] { return run_components(options.name, options.schema, options.all); }};
}

/// The options of all commands, at their defaults.
struct AllOptions {
    PlayOptions play;
    RenderOptions render;
    FilmOptions film;
    FarmCommandOptions farm;
    ViewOptions view;
    BenchOptions bench;
    HashOptions hash;
    CompareOptions compare;
    BakeOptions bake;
    std::string info_file;
    ImportOptions import_options;
    MakeOptions make;
    ExportOptions exported;
    SpeakOptions speak;
    std::vector<std::string> show;
    std::string checked;
    EditOptions edit;
    ComponentsOptions components;
};

std::vector<Command> add_commands(CLI::App& program, AllOptions& options) {
    return {add_play(program, options.play),         add_render(program, options.render),
            add_film_command(program, options.film), add_farm(program, options.farm),
            add_view(program, options.view),         add_bench(program, options.bench),
            add_check(program, options.checked),     add_edit(program, options.edit),
            add_hash(program, options.hash),         add_quality(program),
            add_compare(program, options.compare),   add_bake(program, options.bake),
            add_info(program, options.info_file),    add_import(program, options.import_options),
            add_make(program, options.make),         add_export(program, options.exported),
            add_speak(program, options.speak),       add_levels(program),
            add_shows(program, options.show),        add_components(program, options.components)};
}

/// "limn render" for a parsed subcommand, else "limn".
std::string command_name(const std::vector<Command>& commands) {
    for (const Command& command : commands) {
        if (command.app->parsed()) {
            return "limn " + command.app->get_name();
        }
    }
    return "limn";
}

/// If the first word is neither an option nor a command, prints an error with the nearest command.
bool explain_unknown_command(std::string_view word, const std::vector<Command>& commands) {
    std::vector<std::string> names;
    for (const Command& command : commands) {
        names.push_back(command.app->get_name());
    }
    if (word.starts_with('-') || std::find(names.begin(), names.end(), word) != names.end()) {
        return false;
    }
    const std::string nearest = nearest_name(word, names);
    const std::string hint = nearest.empty() ? "" : fmt::format(" (did you mean {}?)", nearest);
    fmt::print(
        stderr, "limn: found command \"{}\", expected one of {}{}\n", word, fmt::join(names, " "),
        hint);
    return true;
}

}  // namespace

int run_command_line(int argc, char** argv) {
    log_through_spdlog();
    CLI::App program("Limn: a data-oriented ECS engine for game effects.", "limn");
    program.get_formatter()->column_width(28);
    program.set_version_flag("--version", "limn " LIMN_VERSION);
    program.footer("limn COMMAND --help shows details and examples. Start with: limn play");
    AllOptions options;
    for (int i = 0; i < argc; ++i) {
        options.farm.start.command += (i > 0 ? " " : "") + std::string(argv[i]);
    }
    const std::vector<Command> commands = add_commands(program, options);
    program.require_subcommand(0, 1);

    if (argc < 2 || std::string_view(argv[1]) == "help") {
        const auto asked = std::ranges::find_if(commands, [&](const Command& command) {
            return argc > 2 && command.app->get_name() == argv[2];
        });
        if (argc > 2 && explain_unknown_command(argv[2], commands)) {
            return kWrongUsage;
        }
        fmt::print("{}", asked == commands.end() ? program.help() : asked->app->help("limn"));
        return kDone;
    }
    if (explain_unknown_command(argv[1], commands)) {
        return kWrongUsage;
    }
    try {
        program.parse(argc, argv);
    } catch (const CLI::Success& wanted) {  // --help, --version
        return program.exit(wanted);
    } catch (const CLI::Error& error) {
        const std::string name = command_name(commands);
        fmt::print(stderr, "{}: {} ({} --help)\n", name, one_line(error.what()), name);
        return kWrongUsage;
    }
    for (const Command& command : commands) {
        if (!command.app->parsed()) {
            continue;
        }
        const Status status = command.run();
        if (!status) {
            fmt::print(stderr, "{}\n", printable_lines(status.error().message));
            return kFailed;
        }
        return std::fflush(stdout) == 0 ? kDone : kFailed;
    }
    return kDone;
}

}  // namespace limn
