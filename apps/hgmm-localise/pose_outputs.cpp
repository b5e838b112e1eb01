#include "pose_outputs.h"

#include <Eigen/Geometry>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include "hgmm/evaluation/trajectory.h"

namespace localise {

using hgmm::mrpt_bridge::FileKind;
using hgmm::mrpt_bridge::Output;
using hgmm::mrpt_bridge::OutputFile;
using hgmm::mrpt_bridge::Replace;

namespace {

constexpr int kPoseColumns = 7, kCovarianceColumns = 21;

std::string headerRow() {
    std::string header = "time_s,lost,overlap,contradicted,x,y,z,qx,qy,qz,qw";
    const char* names[] = {"wx", "wy", "wz", "x", "y", "z"};
    for (int i = 0; i < 6; ++i)
        for (int j = i; j < 6; ++j) header += std::string(",") + names[i] + "_" + names[j];
    return header + "\n";
}

void addCell(std::string& row, const char* pattern, double value) {
    char text[64];
    std::snprintf(text, sizeof text, pattern, value);
    row += text;
}

std::string rowOf(double time_s, const std::optional<hgmm::TrackedPose>& pose) {
    std::string row;
    addCell(row, "%.6f", time_s);
    row += !pose || pose->lost ? ",1" : ",0";
    addCell(row, ",%.3f", pose ? pose->overlap : 0.0);
    addCell(row, ",%.3f", pose ? pose->contradicted : 0.0);
    if (!pose) return row + std::string(kPoseColumns + kCovarianceColumns, ',') + "\n";
    for (const double metres : pose->T_map_sensor.t) addCell(row, ",%.6f", metres);
    Eigen::Quaterniond q(pose->T_map_sensor.R);
    if (q.w() < 0.0) q.coeffs() *= -1.0;
    for (const double part : q.coeffs()) addCell(row, ",%.9f", part);
    for (int i = 0; i < 6; ++i)
        for (int j = i; j < 6; ++j) addCell(row, ",%.6g", pose->covariance(i, j));
    return row + "\n";
}

void write(std::optional<OutputFile>& file, const std::string& text) {
    if (file) file->write(text.data(), text.size());
}

}  // namespace

PoseOutputs::PoseOutputs(const Options& options) : print_(!options.quiet) {
    const Replace replace = options.force ? Replace::anyKind : Replace::sameKind;
    const Output trajectory{options.trajectory, FileKind::numbers},
        table{options.table, FileKind::text};
    std::vector<std::string> inputs{options.mapFile};
    if (!options.readsStdin()) inputs.push_back(options.log);
    hgmm::mrpt_bridge::checkOutputs({trajectory, table}, inputs, replace);
    if (!trajectory.file.empty()) trajectory_.emplace(trajectory, replace);
    if (!table.file.empty()) table_.emplace(table, replace);
    addRow(headerRow());
}

void PoseOutputs::addRow(const std::string& row) {
    write(table_, row);
    if (!print_) return;
    if (std::fputs(row.c_str(), stdout) < 0 || std::fflush(stdout) != 0)
        throw std::runtime_error("stdout: a row could not be written");
}

void PoseOutputs::add(double time_s, const std::optional<hgmm::TrackedPose>& pose) {
    addRow(rowOf(time_s, pose));
    if (pose && !pose->lost)
        write(trajectory_, hgmm::evaluation::tumText({{time_s, pose->T_map_sensor}}));
}

void PoseOutputs::commit() {
    std::vector<OutputFile*> files;
    for (auto* file : {&trajectory_, &table_})
        if (*file) files.push_back(&**file);
    OutputFile::commitAll(files);
}

}  // namespace localise
