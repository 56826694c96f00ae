#pragma once

#include "content/load/level/level_show.h"

#include <optional>
#include <string>
#include <vector>

namespace limn {

struct HudStyle;

/// Which side of a show is on screen.
enum class ShowSide : std::uint8_t { On, Off, Both };

// F6: the techniques that levels show, by level. Selecting one asks the player to load it; then the
// level is simulated twice, with the technique and without, and either or both are on screen.

class ShowsPanel {
  public:
    /// `shown` is the technique that is loaded; empty: none.
    void draw(const HudStyle& style, const std::string& shown);
    /// The line between off (left) and on (right), with a label on either side.
    void draw_divider(const HudStyle& style) const;

    /// Cycles on, off, side by side.
    void cycle_side();
    /// Selects the show `offset` positions after the loaded one.
    void select_neighbor(const std::string& shown, int offset);
    /// The show selected since the last call.
    [[nodiscard]] std::optional<FoundShow> take_selected();

    bool open = false;
    ShowSide side = ShowSide::On;
    float divider = 0.5f;  ///< of the width of the window

  private:
    void read_list();
    void draw_list(const HudStyle& style, const std::string& shown);
    void draw_shown(const HudStyle& style, const std::string& shown);

    std::vector<FoundShow> shows_;
    std::string error_;
    bool is_read_ = false;
    std::optional<FoundShow> selected_;
};

[[nodiscard]] const char* show_side_name(ShowSide side);

}  // namespace limn
