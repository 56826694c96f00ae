#pragma once

#include "content/app/bench/bench_report.h"
#include "ecs/base/result.h"
#include "render/gpu/device.h"
#include "render/gpu/readback.h"

#include <string>
#include <vector>

namespace limn {

// What `limn bench forms` prints: the cheaper forms of a shader that the book's chapter 11 advises,
// each beside the plain form: how much time it saves here, and what it changes in the image of a
// ball of 18,432 triangles.

// Shown by `limn bench forms`: engine.opt-cpu-const, engine.opt-frag-move
// Shown by `limn bench forms`: engine.opt-lut, engine.opt-normalise

/// One form of the shader, shading_forms.vert and .frag.
struct ShadingForm {
    const char* name;
    std::vector<const char*> defines;
};

struct FormBenchPoint {
    std::string name = {};
    double plain_ms = 0;  ///< of a frame of the plain form
    double ms = 0;        ///< of this one
    double shade = 0;     ///< largest difference of the diffuse share, 0 .. 1
    double angle = 0;     ///< largest difference of an angle [rad]
};

struct FormBench {
    BenchReport machine = {};  ///< size, frames, threads, OpenGL
    std::vector<FormBenchPoint> points = {};
};

/// The plain form is not among them.
[[nodiscard]] const std::vector<ShadingForm>& shading_forms();

/// The ball in one form: red the diffuse share, green and blue the angles / pi; alpha is 0 around
/// it. Fails if the shader does.
[[nodiscard]] Result<gpu::FloatImage>
draw_form(gpu::Device& device, const std::vector<const char*>& defines, const IVec2& size);

/// Largest difference of the channels `first` to `last`, where both images show the ball.
[[nodiscard]] double
form_difference(const gpu::FloatImage& a, const gpu::FloatImage& b, int first, int last);

/// Each form and the plain one are drawn `frames` times in turns, and the fastest counts.
[[nodiscard]] Result<FormBench> measure_forms(gpu::Device& device, const IVec2& size, int frames);

[[nodiscard]] std::string form_bench_table(const FormBench& bench);
[[nodiscard]] std::string form_bench_json(const FormBench& bench);
/// form,ms,plain_ms,ratio,shade,angle
[[nodiscard]] std::string form_bench_csv(const FormBench& bench);

}  // namespace limn
