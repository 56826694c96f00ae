#pragma once

#include "bench/fakephong/fakephong_report.h"

#include <span>
#include <string>

namespace limn::fakephong {

// The tables of the page of fake Phong shading, each an HTML section; `results` are never empty.
// Their text is generated from the numbers.

/// Table 6.1, as printed and as measured, with how far the fitted scenes are from the print.
[[nodiscard]] std::string correctness_section(std::span<const SceneResult> results);
/// The fitted teapot with textures of several sizes: which give the printed order.
[[nodiscard]] std::string texture_section();
/// By color correctness and by work.
[[nodiscard]] std::string ranking_section(std::span<const SceneResult> results);
/// Contradictions within the thesis, or between it and these numbers. Needs all its scenes.
[[nodiscard]] std::string contradiction_section(std::span<const SceneResult> results);
/// The work that each method saves and the correctness it keeps.
[[nodiscard]] std::string worth_section(std::span<const SceneResult> results);
/// Counted operations, per facet and per pixel; with those of forward differences.
[[nodiscard]] std::string work_section(const SceneResult& result);
/// Arcs, and the edges of the scenes, compared with polynomials.
[[nodiscard]] std::string path_section(std::span<const SceneResult> results);

/// One of shading_methods()[1 ..].
[[nodiscard]] const MethodResult& result_of(const SceneResult& scene, std::string_view id);
/// Verdict on a method from its numbers, such as "on fine meshes".
[[nodiscard]] std::string
verdict_of(const ShadingMethod& method, std::span<const SceneResult> results);
/// Work of a frame, set-up included, relative to Phong shading.
[[nodiscard]] double relative_work(const SceneResult& scene, const MethodResult& one);
[[nodiscard]] bool is_fine(const SceneResult& scene);  ///< more than a thousand facets

}  // namespace limn::fakephong
