#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>

namespace limn {

class Inspector;
class World;
struct HudStyle;

// Confirms quitting, or leaving a level with unsaved edits. Enter or Y accepts, Esc or N stays.

class LeaveDialog {
  public:
    /// Asks `question`; `action` is what the button `accept` stands for.
    void ask(std::string question, std::string accept, std::function<void()> action);
    [[nodiscard]] bool is_open() const { return action_ != nullptr; }
    void accept();
    void stay();
    /// The action that was accepted since the last call; run it between frames.
    [[nodiscard]] std::function<void()> take_accepted();

    /// Whether "Save" was pressed since the last call.
    [[nodiscard]] bool take_save() { return std::exchange(saves_, false); }

    /// Draws the question with the number of edits, and buttons that save them and copy them as
    /// JSON.
    void draw(const HudStyle& style, const Inspector& inspector, World& world);

  private:
    std::string question_;
    std::string accept_;
    std::function<void()> action_;    // empty: nothing is asked
    std::function<void()> accepted_;  // to be taken
    bool copied_ = false;             // the edits, since it asks
    bool saves_ = false;
};

}  // namespace limn
