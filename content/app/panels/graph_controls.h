#pragma once

#include "ecs/entity.h"

#include <string>
#include <utility>
#include <vector>

namespace limn {

class World;

// What the inspector shows of a motion graph, and the events that it offers as buttons.

struct GraphView {
    std::string state;                                  ///< "move", or "stand -> move"
    float phase = 0;                                    ///< of the cycle, 0 .. 1
    float clock = 0;                                    ///< of the transition [s]
    float duration = 0;                                 ///< 0: none
    std::vector<std::pair<std::string, float>> clips;   ///< of the state, with their weights
    std::vector<std::pair<std::string, float>> layers;  ///< and how visible they are, 0 .. 1
    std::vector<std::string> events;                    ///< all that the graph knows, each once
};

/// Empty if the entity has no motion graph or that has no state yet.
[[nodiscard]] GraphView view_graph(const World& world, Entity character);

/// For the next step.
void send_graph_event(World& world, Entity character, const std::string& event);

}  // namespace limn
