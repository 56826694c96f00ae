#include "content/app/command_line.h"

int main(int argc, char** argv) {
    return limn::run_command_line(argc, argv);
}
