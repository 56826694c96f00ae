#pragma once

#include "content/app/commands/stage.h"
#include "content/app/panels/buffer_viewer.h"
#include "content/app/panels/furrow_panel.h"
#include "content/app/panels/hud.h"
#include "content/app/panels/inspector.h"
#include "content/app/panels/leave_dialog.h"
#include "content/app/panels/marker_panel.h"
#include "content/app/panels/model_panel.h"
#include "content/app/panels/profiler_panel.h"
#include "content/app/panels/shows_panel.h"
#include "content/app/panels/skeleton_panel.h"
#include "content/app/player/detail_costs.h"
#include "content/app/player/light_drag.h"
#include "content/app/player/pick.h"
#include "content/app/player/play_command.h"
#include "content/app/player/player_camera.h"
#include "content/app/player/player_help.h"
#include "content/app/player/render_scale.h"
#include "content/app/player/skin_drag.h"
#include "content/app/player/sound_output.h"
#include "content/app/player/window.h"
#include "content/game/wrinkle_trial.h"
#include "content/load/made_assets.h"
#include "ecs/components/input.h"
#include "ecs/components/sound_player.h"
#include "render/gpu/device.h"
#include "render/render_frame.h"
#include "render/render_profile.h"
#include "render/render_view.h"

#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace limn {

// The main loop of `limn play`: events, simulation in fixed steps, a frame interpolated between the
// last two steps, the HUD over it. Real time is read only here. A machine that is too slow runs in
// slow motion instead of simulating ever more steps per frame.

class Player {
  public:
    /// Opens the window and loads the scene.
    [[nodiscard]] static Result<std::unique_ptr<Player>> create(const PlayOptions& options);
    Player(const Player&) = delete;
    Player& operator=(const Player&) = delete;

    /// Runs until the window is closed.
    [[nodiscard]] Status run();

    /// Actions of the keys.
    [[nodiscard]] static std::span<const PlayerKey> keys();

  private:
    using Clock = std::chrono::steady_clock;
    [[nodiscard]] static double seconds_between(Clock::time_point begin, Clock::time_point end) {
        return std::chrono::duration<double>(end - begin).count();
    }

    Player(
        std::unique_ptr<Window> window, std::unique_ptr<gpu::Device> device,
        const PlayOptions& options);

    /// Replaces the level; keeps the old one if the new one cannot be loaded. Starts at the time of
    /// the show.
    [[nodiscard]] Status load(const std::string& scene, const std::string& show = {});
    void draw_loading(const std::string& scene, const std::string& step = {});
    void follow_sounds();
    void warm_up_level();
    void load_or_report(const std::string& scene, const std::string& show = {});
    void load_neighbor(int offset);
    /// Runs the action, but asks first if edits would be lost.
    void leave_level(std::function<void()> action, const char* verb = "Leave");
    void ask_to_quit();

    void handle_key(const KeyPress& press);
    /// Closes what Esc closes first: a popup, the panel in use, any panel; asks to quit if there
    /// is none.
    void close_one_or_ask();
    void cycle_show_side();
    /// Steps down the ladder of surface detail, or up.
    void change_detail(int steps);
    void toggle_paths();
    void run_on_selected(Inspector::TreeCommand command);
    void undo_or_redo(bool undo);
    /// Writes the level with the inspector's edits as a new file, and later ones to the same.
    void save_edits();
    [[nodiscard]] Input read_input(const WindowEvents& events, float dt);
    /// Drag and wheel of an orbiting camera, or of a model's initial camera, which then becomes
    /// one.
    void orbit_model(const WindowEvents& events, Input& input, bool on_panel);
    [[nodiscard]] Vec3 model_center() const;
    /// Orbits the selection, and frames it.
    void focus_selection();
    /// An instance of a prefab where the middle of the view is.
    void place_prefab(const std::string& prefab);
    void go_home();
    /// Orbits the point under the pointer.
    void focus_under_pointer();
    void cycle_camera();
    /// Switches to the level's next camera; false if the last one is active.
    bool next_level_camera();
    /// All cameras of the level, the initial one first.
    [[nodiscard]] std::vector<Entity> level_cameras();
    void activate_camera(std::size_t index);
    [[nodiscard]] Ray pointer_ray() const;
    void select_under_pointer();
    /// Whether an editor takes the pointer in this frame, so that it moves no camera.
    [[nodiscard]] bool edit_by_pointer(const WindowEvents& events);
    void edit_furrows();
    /// Shows the skeleton of the selected character, or of the only one; or hides it.
    void toggle_skeleton();
    /// Shows the places of the markers on the face, or hides them.
    void toggle_markers();
    /// Shows them, and the face from the front.
    [[nodiscard]] Status open_markers();
    /// Makes view and light face the entity whose furrows are edited.
    void face_furrows();

    void set_paused(bool paused);
    void simulate(float dt, const Input& input);
    void set_input(World& world, const Input& input) const;
    [[nodiscard]] RenderView move_camera(float dt, const Input& input, const IVec2& size);
    void draw_frame(float dt, const Input& input);
    void show_edits();
    void draw_stages(const IVec2& window_size);
    void draw_off_stage(const IVec2& window_size, int columns);
    void draw_hud(const RenderView& view, const IVec2& window_size, float dt);
    void draw_outline(const RenderView& view) const;
    void fly(float dt, const Input& input);
    [[nodiscard]] std::string describe_motion() const;
    [[nodiscard]] HelpState help_state() const;

    void reload_shaders(bool all);
    /// Applies changes of the level's files to the running level (level_update.h); an error is
    /// shown, and the level stays as it was.
    void follow_level_files();
    /// Modification time of each of them.
    [[nodiscard]] std::vector<std::filesystem::file_time_type> level_file_times() const;
    void save_screenshot(const IVec2& size);
    void save_exr(const RenderView& view);
    /// Takes the renderer that was asked for; fails if nothing can be drawn any more.
    Status follow_renderer();
    void request_next_renderer();
    /// Asks the viewer of a WrinkleTrial, and adds new answers to the file
    /// limn-<level>-answers.csv.
    void follow_trial();
    /// Prints the path and shows a message, or the error.
    void report_saved(const std::string& path, const Status& status);
    [[nodiscard]] std::string next_file(const char* ending);

    PlayOptions options_;
    std::unique_ptr<Window> window_;
    std::unique_ptr<gpu::Device> device_;
    std::optional<ProfileSwitch> profiles_;
    Renderer* renderer_ = nullptr;  ///< of profiles_
    std::unique_ptr<Hud> hud_;
    std::optional<BufferViewer> buffers_;
    std::unique_ptr<Stage> stage_;
    MadeAssets made_;
    std::size_t trials_saved_ = 0;  ///< answers of the level's WrinkleTrial that are in the file

    // The level without the technique of options_.show, beside the one with it.
    std::unique_ptr<Stage> off_stage_;
    RendererPtr off_renderer_;
    ShowsPanel shows_;
    ViewRequest view_request_;  ///< of the last frame

    Entity first_camera_{};

    Inspector inspector_;
    ProfilerPanel profiler_;
    ModelPanel model_panel_;
    FurrowPanel furrows_;
    SkeletonPanel skeleton_;
    MarkerPanel markers_;
    LightDrag light_;
    SkinDrag skin_;
    LeaveDialog leave_;
    PlayerCamera camera_;
    RenderScale scale_;
    RenderView view_;  ///< of the last frame
    FrameRequest request_ = {.aovs = {}, .paced = true};
    IVec2 last_window_size_ = {0, 0};
    std::string shader_error_;
    std::string level_error_;
    std::vector<std::filesystem::file_time_type> level_times_;
    FrameCost cost_;

    double unsimulated_ = 0.0;         ///< real time not simulated yet [s]
    double shown_time_ = 0.0;          ///< simulation time of the last frame [s]
    double until_shader_check_ = 0.0;  ///< [s]
    double until_pick_ = 0.0;          ///< [s] until the distance ahead is measured again
    float ahead_ = INFINITY;           ///< distance to what the camera looks at [m]
    SoundOutput sound_;
    std::vector<SoundPlayer> sound_players_;  ///< that sound_ plays
    std::string sound_scene_;                 ///< whose they are
    double real_seconds_ = 0.0;               ///< of the window in which rate_ is measured
    double simulated_seconds_ = 0.0;          ///< likewise
    double rate_ = 1.0;                       ///< simulated seconds per real second
    bool gamepad_click_ = false;              ///< A was down in the last frame
    bool pointer_taken_ = false;              ///< by an editor
    bool paused_ = false;
    bool step_once_ = false;
    DetailCosts detail_costs_;
    bool paths_shown_ = false;
    std::uint64_t shown_revision_ = 0;  ///< of the edits (UndoStack::revision)
    bool files_changed_ = false;        ///< of the level or the shaders, since the last frame
    bool screenshot_wanted_ = false;
    bool screenshot_with_hud_ = false;
    bool exr_wanted_ = false;
    int files_saved_ = 0;
    std::string edited_path_;  ///< of the level that save_edits wrote since the level was loaded
};

}  // namespace limn
