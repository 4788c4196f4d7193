#include "cli/help.h"

#include <CLI/CLI.hpp>
#include <span>

#include "base/atomic_file.h"
#include "cli/advice.h"
#include "cli/completion.h"
#include "cli/manual.h"
#include "cli/output.h"

namespace lumulus::cli {
namespace {

void writeText(const std::filesystem::path& path, const std::string& text) {
    std::error_code failure;
    std::filesystem::create_directories(path.parent_path(), failure);  // writing tells of a failure
    writeFile(path, std::as_bytes(std::span(text)));
}

void writeFiles(const CLI::App& app, const std::filesystem::path& folder) {
    const std::filesystem::path pages = folder / "man/man1";
    writeText(pages / "lumulus.1", programManual(app));
    for (const std::string& name : commandNames(app))
        writeText(pages / ("lumulus-" + name + ".1"), commandManual(app, commandOf(app, name)));
    writeText(folder / "bash-completion/completions/lumulus", bashCompletion(app));
}

}  // namespace

void runHelp(const CLI::App& app, const HelpOptions& options) {
    if (!options.files.empty())
        writeFiles(app, options.files);
    else if (!options.command.empty())
        printOut(commandOf(app, options.command).help("lumulus"));
    else  // App::help() would be that of the command "help"
        printOut(app.get_formatter()->make_help(&app, "lumulus", CLI::AppFormatMode::Normal));
}

}  // namespace lumulus::cli
