#include "content/app/commands/command_line.h"

int main(int argc, char** argv) {
    return limn::run_command_line(argc, argv);
}
