#pragma once
#include <CLI/CLI.hpp>

/// Lists separated by commas end with their argument: what follows on the command line is
/// not taken for more of them, so that options stand anywhere. For a program and its
/// commands, once all options are defined.
inline void endListsWithTheirArgument(CLI::App& app) {
    for (CLI::Option* option : app.get_options())
        if (option->get_delimiter() != '\0') option->allow_extra_args(false);
    for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; }))
        endListsWithTheirArgument(*command);
}
