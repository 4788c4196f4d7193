#include "base/interrupt.h"
#include "cli/cli.h"

int main(int argc, char** argv) {
    lumulus::installSignalHandlers();
    return lumulus::cli::run(argc, argv);
}
