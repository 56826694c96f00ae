#pragma once

#include <string>

namespace limn::test {

/// Sends the windows of an X display what the close button of their frame would send. False where
/// there is no such display or window.
[[nodiscard]] bool close_window(const std::string& display);

}  // namespace limn::test
