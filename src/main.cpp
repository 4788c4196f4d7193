#include "cli/cli.h"

int main(int argc, char** argv) {
    return lumulus::cli::run(argc, argv);
}
