#include <cmath>
#include <regex>
#include <set>
#include <sstream>
#include <vector>

#include "replay_map_fixture.h"

/// Opens report.html in headless Chromium (Debian's package; scripts/install-deps.sh).
class ReportPage : public ReplayFolder {
 protected:
    void SetUp() override {
        ReplayFolder::SetUp();
        ASSERT_EQ(std::system("command -v chromium >/dev/null"), 0)
            << "no chromium: see scripts/install-deps.sh";
    }

    /// Of real scans of a laser scanner, with their odometry; some test the maps.
    void makeReport() const {
        const Outcome outcome = replay(
            "'/usr/share/mrpt/datasets/2006-01ENE-21-SENA_Telecom "
            "Faculty_one_loop_only.rawlog' --to 60 --split 5 --baselines octomap:0.2 "
            "--report '" +
            path("report") + "'");
        ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
        ASSERT_NE(content("report/report.html"), "");
    }

    /// The document as Chromium has it once the page and its scripts are through. Its log
    /// of errors goes to `console`.
    std::string open(const std::string& name, std::string& console) const {
        const std::string command =
            "timeout 120 chromium --headless=new --no-sandbox --disable-gpu "
            "--hide-scrollbars "
            "--disable-dev-shm-usage --disable-background-networking "
            "--allow-file-access-from-files --user-data-dir='" +
            path("profile") +
            "' --enable-logging=stderr --v=0 --virtual-time-budget=5000 --dump-dom "
            "'file://" +
            path(name) + "' >'" + path("dom") + "' 2>'" + path("log") + "' </dev/null";
        EXPECT_EQ(std::system(command.c_str()), 0) << content("log");
        console.clear();
        std::istringstream log(content("log"));
        for (std::string line; std::getline(log, line);)
            if (line.find("CONSOLE") != std::string::npos) console += line + "\n";
        return content("dom");
    }

    void write(const std::string& name, const std::string& text) const {
        std::ofstream(path(name)) << text;
    }

    /// Width that the page needs when it has this much [px].
    int widthNeeded(const std::string& name, int width_px) const {
        // A window cannot be that narrow, but a frame can.
        write("frame.html",
              "<!DOCTYPE html><iframe id=f style='width:" + std::to_string(width_px) +
                  "px;height:800px;border:0' src='" + name +
                  "'></iframe><script>f.onload=()=>document.title='width '+"
                  "f.contentDocument.documentElement.scrollWidth</script>");
        std::string console;
        const std::string dom = open("frame.html", console);
        std::smatch width;
        if (!std::regex_search(dom, width, std::regex("<title>width ([0-9]+)</title>")))
            return -1;
        return std::stoi(width[1]);
    }
};

/// The text of each element of a name; they must not be nested.
static std::vector<std::string> elements(const std::string& dom, const std::string& name) {
    std::vector<std::string> found;
    for (std::size_t at = dom.find("<" + name); at != std::string::npos;
         at = dom.find("<" + name, at + 1))
        found.push_back(dom.substr(at, dom.find("</" + name + ">", at) - at));
    return found;
}

/// Whether a line of this curve joins distinct finite points, or a mark shows its only one.
static bool hasData(const std::string& svg, const std::string& curve) {
    const std::size_t at = svg.find("<title>" + curve + "</title>");
    if (at == std::string::npos) return false;
    const std::string group = svg.substr(at, svg.find("</g>", at) - at);
    const std::size_t line = group.find("<polyline");
    if (line == std::string::npos)
        return group.find(" cx=") != std::string::npos ||
               group.find("<polygon") != std::string::npos;
    const std::size_t begin = group.find("points=", line) + 8;
    std::istringstream text(group.substr(begin, group.find('"', begin) - begin));
    std::set<std::string> points;
    for (std::string point; text >> point;) {
        double x = 0, y = 0;
        if (std::sscanf(point.c_str(), "%lf,%lf", &x, &y) != 2) return false;
        if (!std::isfinite(x) || !std::isfinite(y)) return false;
        points.insert(point);
    }
    return points.size() >= 2;
}

TEST_F(ReportPage, EveryPlotHasDataAndTheConsoleIsQuiet) {
    makeReport();
    std::string console;
    const std::string dom = open("report/report.html", console);
    EXPECT_EQ(console, "");
    expectHas(dom, "SENA_Telecom Faculty");
    expectHas(dom, "mrpt::maps::COctoMap");
    const auto plots = elements(dom, "svg");
    ASSERT_EQ(plots.size(), 6U);
    for (const std::string& svg : plots)
        for (const char* map : {"hgmm", "octomap:0.2"})
            EXPECT_TRUE(hasData(svg, map)) << map << " in " << svg;
    EXPECT_EQ(elements(dom, "table").size(), 2U);
    EXPECT_GE(elements(dom, "img").size(), 2U);
    EXPECT_LT(content("report/report.html").size(), 1500000U);
}

TEST_F(ReportPage, NothingIsWiderThanTheWindow) {
    makeReport();
    for (const int width_px : {390, 768, 1280})
        EXPECT_EQ(widthNeeded("report/report.html", width_px), width_px);
}

TEST_F(ReportPage, TheTestsSeeErrorsAndOverflow) {
    write(
        "bad.html",
        "<!DOCTYPE html><div style='width:700px'>x</div><script>undefinedCall()</script>");
    std::string console;
    open("bad.html", console);
    expectHas(console, "undefinedCall");
    EXPECT_GE(widthNeeded("bad.html", 390), 700);
}
