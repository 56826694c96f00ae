#include "content/app/panels/field_widgets.h"
#include "content/app/panels/hud_style.h"
#include "content/app/panels/inspector.h"
#include "ecs/components/all.h"
#include "ecs/components/environment.h"
#include "ecs/components/light.h"
#include "ecs/components/name.h"
#include "ecs/components/particles.h"
#include "ecs/components/ripple.h"
#include "ecs/components/surface.h"
#include "ecs/components/transform.h"
#include "ecs/hierarchy.h"
#include "ecs/schedule.h"
#include "ecs/snapshot.h"
#include "ecs/world.h"
#include "tests/technique.h"

#include <doctest/doctest.h>
#include <imgui.h>

#include <string>
#include <string_view>
#include <vector>

namespace limn::inspector_test {
namespace {

/// ImGui without a window: its frames are built and thrown away.
class OffscreenHud {
  public:
    OffscreenHud() {
        ImGui::CreateContext();
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.DisplaySize = {1280, 720};
        style = apply_hud_style(1.0f);
        unsigned char* pixels = nullptr;
        int width = 0;
        int height = 0;
        io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
    }
    OffscreenHud(const OffscreenHud&) = delete;
    OffscreenHud& operator=(const OffscreenHud&) = delete;
    ~OffscreenHud() { ImGui::DestroyContext(); }

    /// One frame with the pointer at `mouse`.
    template <typename Draw>
    void frame(Draw draw, const ImVec2& mouse = {-1, -1}, bool pressed = false) const {
        ImGuiIO& io = ImGui::GetIO();
        io.DeltaTime = 1.0f / 60.0f;
        io.MousePos = mouse;
        io.MouseDown[0] = pressed;
        ImGui::NewFrame();
        draw();
        ImGui::EndFrame();
    }

    /// The text of one window in one frame.
    template <typename Draw>
    [[nodiscard]] std::string text(Draw draw) const {
        ImGui::SetClipboardText("");
        frame([&] {
            ImGui::LogToClipboard();  // until the window ends
            draw();
        });
        return ImGui::GetClipboardText();
    }

    HudStyle style;
};

/// A world with one entity that has every registered component, and every resource.
Entity make_everything(World& world) {
    register_all_components();
    const Entity entity = world.create(Name{"everything"});
    for (const ComponentInfo* info : all_components()) {
        if (info->ops.construct_default != nullptr && info->id != component_id<Parent>) {
            static_cast<void>(world.add(entity, info->id));
        }
    }
    for (const ComponentInfo* info : all_resources()) {
        if (info->ops.construct_default != nullptr) {
            static_cast<void>(world.insert_default_resource(info->id));
        }
    }
    world.insert_resource(Assets{}).materials.emplace_back().name = "clay";
    return entity;
}

}  // namespace

TEST_CASE("inspector: looking at every component changes nothing") {
    const OffscreenHud hud;
    World world;
    const Entity entity = make_everything(world);
    Inspector inspector;
    inspector.open = true;
    inspector.select(entity);
    const std::uint64_t before = state_hash(world);
    for (int i = 0; i < 5; ++i) {
        hud.frame([&] { inspector.draw(hud.style, world, Schedule()); });
    }
    CHECK(state_hash(world) == before);
    CHECK(inspector.undo_stack().undo_count() == 0);
    for (const ComponentInfo* info : all_components()) {
        if (info->defaults == nullptr) {
            continue;
        }
        AnyComponent value(*info, info->defaults);
        CAPTURE(info->name);
        hud.frame([&] {
            ImGui::Begin("one");
            CHECK_FALSE(edit_fields(hud.style, world, *info, value.data()).changed);
            ImGui::End();
        });
    }
}

TEST_CASE(
    "inspector: every kind of component shows the fields of its description, in their order"
    * technique("engine.editor-inspector")) {
    const OffscreenHud hud;
    World world;
    make_everything(world);
    std::size_t kinds = 0;
    for (const ComponentInfo* info : all_components()) {
        if (info->defaults == nullptr || info->fields.empty()) {
            continue;
        }
        AnyComponent value(*info, info->defaults);
        const std::string text = hud.text([&] {
            ImGui::Begin("one");
            ImGui::SetWindowSize({400, 4000});
            edit_fields(hud.style, world, *info, value.data());
            ImGui::End();
        });
        CAPTURE(info->name);
        CAPTURE(text);
        std::size_t at = 0;
        for (const FieldInfo& field : info->fields) {
            CAPTURE(field.name);
            at = text.find(field.name, at);
            REQUIRE(at != std::string::npos);
            at += std::string_view(field.name).size();
        }
        ++kinds;
    }
    CHECK(kinds > 100);
}

TEST_CASE(
    "inspector: what is pasted is selected; what is deleted is not shown, and comes back by undo"
    * technique("engine.cut-copy-paste")) {
    const OffscreenHud hud;
    World world;
    register_all_components();
    world.insert_resource(Assets{});
    const Entity post = world.create(Name{"post"}, Transform{});
    const Entity lamp = world.create(Name{"lamp"}, Transform{}, Parent{post});
    Inspector inspector;
    inspector.open = true;
    inspector.select(lamp);
    const auto text = [&] {
        return hud.text([&] { inspector.draw(hud.style, world, Schedule()); });
    };
    CHECK(inspector.run(world, Inspector::TreeCommand::Duplicate) == "lamp 2: copied");
    CHECK(inspector.selected() != lamp);
    CHECK(parent_of(world, inspector.selected()) == post);
    CHECK(text().find("lamp 2") != std::string::npos);
    CHECK(inspector.edit_count() == 1);  // though it is two changes
    inspector.select(post);
    CHECK(inspector.run(world, Inspector::TreeCommand::Delete) == "post: delete");
    CHECK(inspector.selected().is_null());
    CHECK(text().find("lamp") == std::string::npos);
    inspector.undo_stack().undo(world);
    inspector.select(post);
    CHECK(text().find("lamp 2") != std::string::npos);
    CHECK(inspector.run(world, Inspector::TreeCommand::Paste).starts_with("paste: nothing"));
    CHECK(inspector.take_message().empty());
}

TEST_CASE("inspector: a drag of a slider sets the component and is one step of undo") {
    const OffscreenHud hud;
    World world;
    register_all_components();
    // One field with a range: a slider as wide as the right part of the panel.
    world.insert_resource(Assets{});
    const Entity entity = world.create(HeatHaze{});
    Inspector inspector;
    inspector.open = true;
    inspector.select(entity);
    const auto draw = [&] { inspector.draw(hud.style, world, Schedule()); };
    for (int i = 0; i < 3; ++i) {
        hud.frame(draw);
    }
    constexpr float kStrength = HeatHaze{}.strength;
    const auto strength = [&] { return world.get<const HeatHaze>(entity).strength; };
    // Look for it: press at every height until the strength changes.
    const float x = 1130.0f;
    float y = 150.0f;
    for (; y < 700.0f && strength() == kStrength; y += 5.0f) {
        hud.frame(draw, {x, y});
        hud.frame(draw, {x, y}, true);
        if (strength() != kStrength) {
            break;
        }
        hud.frame(draw, {x, y});
    }
    REQUIRE(strength() != kStrength);
    for (int i = 0; i < 20; ++i) {
        hud.frame(draw, {x + 4.0f * static_cast<float>(i), y}, true);
    }
    hud.frame(draw, {x + 80.0f, y});
    const float dragged = strength();
    CHECK(dragged > kStrength);
    CHECK(dragged <= 0.2f);
    CHECK(inspector.undo_stack().undo_count() == 1);
    CHECK(inspector.undo_stack().undo(world).find("heat_haze.strength") != std::string::npos);
    CHECK(strength() == kStrength);
    CHECK_FALSE(inspector.undo_stack().redo(world).empty());
    CHECK(strength() == dragged);
}

TEST_CASE(
    "inspector: keys of a curve are added by a double click and dragged, a step of undo each") {
    const OffscreenHud hud;
    World world;
    register_all_components();
    world.insert_resource(Assets{});
    const std::vector<CurveKey> ends = {{0, 1}, {1, 0}};
    const Entity entity = world.create(ParticleLight{.curve = ends});
    Inspector inspector;
    inspector.open = true;
    inspector.select(entity);
    const auto draw = [&] { inspector.draw(hud.style, world, Schedule()); };
    for (int i = 0; i < 3; ++i) {
        hud.frame(draw);
    }
    const auto curve = [&] { return world.get<const ParticleLight>(entity).curve; };
    // Look for it: double clicks at every height until one adds a key.
    const float x = 1130.0f;
    const auto double_click = [&](float y) {
        for (int i = 0; i < 40; ++i) {
            hud.frame(draw, {x, y});  // later than a third click of the last one
        }
        for (const bool pressed : {true, false, true, false}) {
            hud.frame(draw, {x, y}, pressed);
        }
    };
    float y = 150.0f;
    for (; y < 700.0f; y += 8.0f) {
        double_click(y);
        if (curve().size() != 2) {
            break;
        }
    }
    REQUIRE(curve().size() == 3);
    // That was at its upper edge, above the scale; one lower down leaves the scale alone.
    static_cast<void>(inspector.undo_stack().undo(world));
    CHECK(curve().size() == 2);
    y += 40.0f;
    double_click(y);
    REQUIRE(curve().size() == 3);
    const std::vector<CurveKey> added = curve();
    const std::size_t steps = inspector.undo_stack().undo_count();
    CHECK(added[1].at > 0);
    CHECK(added[1].at < 1);
    CHECK(added[1].value > 0);

    for (int i = 0; i < 40; ++i) {
        hud.frame(draw, {x, y});
    }
    for (int i = 0; i <= 10; ++i) {
        hud.frame(draw, {x + 2.0f * static_cast<float>(i), y + static_cast<float>(i)}, true);
    }
    hud.frame(draw, {x + 20.0f, y + 10.0f});
    const std::vector<CurveKey> dragged = curve();
    REQUIRE(dragged.size() == 3);
    CHECK(dragged[1].at > added[1].at);
    CHECK(dragged[1].value < added[1].value);
    CHECK(dragged[0].value == ends[0].value);
    CHECK(dragged[2].value == ends[1].value);
    CHECK(inspector.undo_stack().undo_count() == steps + 1);
    CHECK(inspector.undo_stack().undo(world).find("particle_light.curve") != std::string::npos);
    CHECK(curve()[1].at == added[1].at);
    CHECK(curve()[1].value == added[1].value);
}

TEST_CASE("inspector: a color has the numbers of the file, and its swatch says that it is sRGB") {
    const OffscreenHud hud;
    World world;
    register_all_components();
    PointLight light{.color = {0.5f, 0.25f, 0.125f}};
    const auto draw = [&] {
        ImGui::SetNextWindowSize({500, 500});
        ImGui::Begin("one");
        static_cast<void>(edit_fields(hud.style, world, component_info<PointLight>(), &light));
        ImGui::End();
    };
    hud.frame(draw);
    const std::string text = hud.text(draw);
    CAPTURE(text);
    const std::size_t red = text.find("0.5 ");
    const std::size_t green = text.find("0.25 ", red);
    const std::size_t blue = text.find("0.125 ", green);
    REQUIRE(blue != std::string::npos);
    CHECK(text.find("sRGB", blue) != std::string::npos);
    CHECK(text.find("0.735") == std::string::npos);  // 0.5 in sRGB
}

TEST_CASE("inspector: fields that the material's shading model does not use are collapsed") {
    register_all_components();
    for (const ShadingModel model : {ShadingModel::Pbr, ShadingModel::Skin}) {
        const OffscreenHud hud;
        World world;
        world.insert_resource(Assets{}).materials.push_back({.name = "clay", .shading = model});
        Inspector inspector;
        inspector.open = true;
        const auto draw = [&] { inspector.draw(hud.style, world, Schedule()); };
        for (int i = 0; i < 3; ++i) {
            hud.frame(draw);
        }
        const auto click = [&](const ImVec2& at) {
            hud.frame(draw, at);
            hud.frame(draw, at, true);
            hud.frame(draw, at);
        };
        std::string text;
        for (float x = 900; x < 1250 && text.find("clay") == std::string::npos; x += 10) {
            click({x, 76});  // the tab "Materials"
            hud.frame([&] {
                ImGui::LogToClipboard(0);  // opens nothing that is folded
                draw();
            });
            text = ImGui::GetClipboardText();
        }
        CAPTURE(text);
        const bool is_skin = model == ShadingModel::Skin;
        CHECK(text.find(is_skin ? "not used by skin" : "not used by pbr") != std::string::npos);
        CHECK((text.find("skin_color") != std::string::npos) == is_skin);
        CHECK((text.find("metalness") != std::string::npos) != is_skin);
        CHECK(text.find("base_color") != std::string::npos);
    }
}

TEST_CASE("inspector: entities are found by their name, a component or a field") {
    register_all_components();
    struct Case {
        const char* words;
        bool lamp;
        bool teapot;
    };
    for (const Case& one :
         {Case{"", true, true},
          {"LAM", true, false},
          {"mesh_inst", false, true},
          {"intensity", true, false},
          {"illumin", false, false}}) {
        const OffscreenHud hud;
        World world;
        world.create(Name{"lamp"}, PointLight{});
        world.create(Name{"teapot"}, MeshInstance{});
        Inspector inspector;
        inspector.open = true;
        const auto draw = [&] { inspector.draw(hud.style, world, Schedule()); };
        for (int i = 0; i < 3; ++i) {
            hud.frame(draw);
        }
        // Into the search field, near the top.
        hud.frame(draw, {1100, 104});
        hud.frame(draw, {1100, 104}, true);
        hud.frame(draw, {1100, 104});
        ImGui::GetIO().AddInputCharactersUTF8(one.words);
        hud.frame(draw, {1100, 104});
        const std::string text = hud.text(draw);
        CAPTURE(text);
        CHECK((text.find("lamp") != std::string::npos) == one.lamp);
        CHECK((text.find("teapot") != std::string::npos) == one.teapot);
    }
}

TEST_CASE("inspector: unnamed entities are labeled by their mesh or kind") {
    World world;
    world.insert_resource(Assets{}).meshes.emplace_back().name = "teapot";
    CHECK(entity_label(world, world.create(Name{"lamp"}, PointLight{})) == "lamp");
    CHECK(entity_label(world, world.create(PointLight{})).starts_with("point light "));
    CHECK(entity_label(world, world.create(MeshInstance{{0}, {}})).starts_with("teapot "));
    CHECK(entity_label(world, world.create(Transform{})).starts_with("entity "));
}

TEST_CASE("inspector: the selected entity may vanish at any time") {
    const OffscreenHud hud;
    World world;
    register_all_components();
    const Entity parent = world.create(Name{"parent"});
    const Entity child = world.create(Name{"child"}, Parent{parent});
    Inspector inspector;
    inspector.open = true;
    inspector.select(child);
    const auto draw = [&] { inspector.draw(hud.style, world, Schedule()); };
    hud.frame(draw);
    world.destroy(child);
    hud.frame(draw);
    world.destroy(parent);
    for (int i = 0; i < 40; ++i) {  // long enough for the list to be built anew
        hud.frame(draw);
    }
    CHECK_FALSE(world.alive(inspector.selected()));
}

}  // namespace limn::inspector_test
