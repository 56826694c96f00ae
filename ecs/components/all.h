#pragma once

namespace limn {

/// Registers every component and resource of the engine by name. Idempotent.
void register_all_components();

}  // namespace limn
