#include "ecs/components/rendering.h"
#include "render/gpu/branch_cost.h"
#include "tests/render/scene_fixture.h"
#include "tests/technique.h"

#include <doctest/doctest.h>

#include <cmath>

namespace limn::test::branch_cost_test {

using gpu::BranchForm;
using gpu::choose_branch;
using gpu::should_unroll;

TEST_CASE(
    "branch cost: a jump pays where it skips more cycles than it costs"
    * technique("shade.control-flow")) {
    CHECK(choose_branch(8, 0.5, true) == BranchForm::Masked);  // saves 4, costs 6
    CHECK(choose_branch(40, 0.5, true) == BranchForm::Jump);   // saves 20
    CHECK(choose_branch(10, 0.5, true) == BranchForm::Masked);
    CHECK(choose_branch(10, 0.5, false) == BranchForm::Jump);  // saves 5, costs 4
    CHECK(choose_branch(1000, 0, false) == BranchForm::Masked);
    CHECK(should_unroll(4, 100));
    CHECK_FALSE(should_unroll(4, 1000));
    CHECK_FALSE(should_unroll(gpu::kMaxUnrolled + 1, 100));
}

TEST_CASE_FIXTURE(
    Scene, "branch cost: five lights give the same pixels by a uniform loop and unrolled"
               * technique("shade.control-flow")) {
    for (const LightMethod method : {LightMethod::Clustered, LightMethod::ObjectMajor}) {
        gpu::FloatImage uniform;
        for (const LightLoops loops :
             {LightLoops::Uniform, LightLoops::Unrolled, LightLoops::Auto}) {
            world.clear();
            world.insert_resource(Rendering{.lights = method, .light_loops = loops});
            for (int i = 0; i < 5; ++i) {
                const float angle = 1.2f * static_cast<float>(i);
                shine(
                    DirectionalLight{.illuminance = 1},
                    look_at({std::cos(angle), std::sin(angle), 1}, {0, 0, 0}));
            }
            place(add(make_ball(24)), add(Material{.roughness = 0.4f}), at({0, 0, 0}));
            const gpu::FloatImage image = radiance(look({0.3f, 0.4f, 2}, {0, 0, 0}, 48, 48));
            if (loops == LightLoops::Uniform) {
                uniform = image;
                REQUIRE(rgb_at(uniform, 24, 24).x > 0.1f);
            }
            CAPTURE(static_cast<int>(loops));
            CHECK(largest_difference(image, uniform) <= 1e-6f);
        }
    }
}

}  // namespace limn::test::branch_cost_test
