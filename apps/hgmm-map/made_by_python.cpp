#include "made_by_python.h"

#include <cstdio>
#include <stdexcept>
#include <utility>

#include "hgmm/evaluation/python_module.h"

namespace maptool {

std::string madeByPython(const std::string& module,
                         const std::vector<std::string>& arguments) {
    hgmm::evaluation::PythonRun made = hgmm::evaluation::runPython(module, arguments);
    const std::string prefix = module + ": ";
    if (!made.done)
        throw std::runtime_error(made.message.compare(0, prefix.size(), prefix) == 0
                                     ? made.message.substr(prefix.size())
                                     : made.message);
    std::fputs(made.message.c_str(), stderr);
    return std::move(made.output);
}

}  // namespace maptool
