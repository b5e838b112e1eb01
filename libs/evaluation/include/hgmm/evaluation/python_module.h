#pragma once
#include <string>
#include <vector>

namespace hgmm::evaluation {

/// What a program of the Python package said.
struct PythonRun {
    bool done = false;    ///< it ended with exit code 0
    std::string output;   ///< what it wrote
    std::string message;  ///< its warnings; if it is not done, one sentence that says why
};

/// Runs `python3 -m MODULE ARGUMENTS`. The Python is that which HGMM_PYTHON names, else
/// Debian's /usr/bin/python3, else the first in PATH. In a build tree it takes the package
/// hgmm from the folder `python` beside that of the program, else an installed one.
PythonRun runPython(const std::string& module, const std::vector<std::string>& arguments);

}  // namespace hgmm::evaluation
