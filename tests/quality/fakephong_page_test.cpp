#include "bench/fakephong/phong_models.h"
#include "bench/quality/fakephong_page.h"
#include "bench/quality/fakephong_tables.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <string>
#include <vector>

namespace limn::fakephong::fakephong_page_test {
namespace {

/// One small scene, evaluated once.
const SceneResult& small_result() {
    static const SceneResult result = [] {
        PhongScene scene = sphere_scene();
        scene.camera.size = 64;
        scene.row = 26;
        return evaluate_scene(scene);
    }();
    return result;
}

/// The y of the n-th curve of a page.
std::vector<double> curve(const std::string& page, int n) {
    const std::string start = "<polyline points=\"";
    std::size_t at = page.find(start);
    for (int i = 0; i < n; ++i) {
        at = page.find(start, at + 1);
    }
    REQUIRE(at != std::string::npos);
    at += start.size();
    std::istringstream points(page.substr(at, page.find('"', at) - at));
    std::vector<double> heights;
    double x = 0;
    double y = 0;
    char comma = 0;
    while (points >> x >> comma >> y) {
        heights.push_back(y);
    }
    return heights;
}

}  // namespace

TEST_CASE("fakephong page: plots have Phong's curve and then the method's, linear in brightness") {
    const SceneResult& result = small_result();
    const std::string page = fakephong_html({&result, 1}).value();
    const auto plotted = [&](int n, const PhongImage& image) {
        const std::vector<float> wanted = scanline(image.color, result.scene.row);
        const std::vector<double> found = curve(page, n);
        REQUIRE(found.size() == wanted.size());
        // 0 at the edge of the image, and the highest value, fix the scale.
        const auto peak = static_cast<std::size_t>(
            std::max_element(wanted.begin(), wanted.end()) - wanted.begin());
        REQUIRE(wanted[peak] > 0.1f);
        REQUIRE(wanted[0] == 0);
        const double height = found[0] - found[peak];
        CHECK(height > 10);
        for (std::size_t x = 0; x < wanted.size(); ++x) {
            const auto fraction = static_cast<double>(wanted[x] / wanted[peak]);
            CHECK(std::abs((found[0] - found[x]) / height - fraction) < 0.2 / height);
        }
        return height / static_cast<double>(wanted[peak]);
    };
    const double scale = plotted(0, result.phong);
    CHECK(std::abs(plotted(1, result.methods[0].image) - scale) < 0.01 * scale);
}

TEST_CASE("fakephong page: the text on a method states its numbers") {
    SceneResult result = small_result();
    const ShadingMethod& blinn = *find_method("blinn-map");
    const std::string said = describe_method(blinn, {&result, 1});
    CHECK(said.find("Its correctness is 0.98") == 0);
    CHECK(said.find("exact, between them wrong by up to 0.") != std::string::npos);
    CHECK(said.find("Worth it on coarse meshes.") != std::string::npos);

    auto& changed =
        *std::find_if(result.methods.begin(), result.methods.end(), [&](const MethodResult& one) {
            return one.method == &blinn;
        });
    changed.correctness = 0.5;
    changed.error_at_samples = 0.25;
    changed.scanline = {.peak_shift = -3, .peak_ratio = 0.75};
    const std::string other = describe_method(blinn, {&result, 1});
    CHECK(other.find("correctness is 0.5000") != std::string::npos);
    CHECK(
        other.find("the peak is 3 px left of Phong's, at 0.75 of its height") != std::string::npos);
    CHECK(
        other.find("Even at its own sample points it is wrong by up to 0.25") != std::string::npos);
    CHECK(other.find("Worth it where a highlight need only be hinted at.") != std::string::npos);
    changed.image.shading.powers += 1'000'000;
    CHECK(verdict_of(blinn, {&result, 1}) == "nowhere: it costs what Phong shading costs");
}

}  // namespace limn::fakephong::fakephong_page_test
