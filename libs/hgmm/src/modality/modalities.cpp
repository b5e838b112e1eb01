#include "modality/modalities.h"

#include <algorithm>

#include "hgmm/params.h"
#include "modality/channel_samples.h"

namespace hgmm {

namespace {

using Names = std::vector<std::string>;

bool contains(const Names& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

/// Channels of a scan that are measured at the same points.
using ChannelGroup = std::vector<const Channel*>;

bool measuredTogether(const Channel& a, const Channel& b) {
    unsigned apart = 0;  // counted without branches: several points at a time
    for (std::size_t i = 0; i < a.values.size(); ++i)
        apart |= unsigned(isMeasured(a.values[i])) ^ unsigned(isMeasured(b.values[i]));
    return apart == 0;
}

bool measuredAnywhere(const Channel& channel) {
    return std::any_of(channel.values.begin(), channel.values.end(), isMeasured);
}

std::vector<ChannelGroup> groupsOf(const Scan& scan, const Names& modalities) {
    std::vector<ChannelGroup> groups;
    for (const std::string& name : modalities) {
        const auto channel = std::find_if(scan.channels.begin(), scan.channels.end(),
                                          [&](const Channel& c) { return c.name == name; });
        if (channel == scan.channels.end() || !measuredAnywhere(*channel)) continue;
        const auto group = std::find_if(
            groups.begin(), groups.end(),
            [&](const ChannelGroup& g) { return measuredTogether(*g.front(), *channel); });
        if (group != groups.end())
            group->push_back(&*channel);
        else
            groups.push_back({&*channel});
    }
    return groups;
}

Names intersection(const Names& a, const Names& b) {
    Names both;
    for (const std::string& name : a)
        if (contains(b, name)) both.push_back(name);
    return both;
}

Names difference(const Names& a, const Names& b) {
    Names rest;
    for (const std::string& name : a)
        if (!contains(b, name)) rest.push_back(name);
    return rest;
}

}  // namespace

Modalities::Modalities(const Modalities& o) : groups_(o.groups_), hierarchy_(o.hierarchy_) {
    relink();
}

Modalities& Modalities::operator=(const Modalities& o) {
    if (this != &o) *this = Modalities(o);
    return *this;
}

Modalities Modalities::within(const Eigen::AlignedBox3f& box) const {
    Modalities part;
    part.hierarchy_ = hierarchy_;
    for (const ModalityGroup& group : groups_) {
        ModalityGroup some = group.within(box);
        if (!some.mixture().empty()) part.groups_.push_back(std::move(some));
    }
    part.relink();
    return part;
}

void Modalities::insert(const Scan& scan, const Pose& T_local_sensor,
                        const MapParams& params) {
    for (const ChannelGroup& together : groupsOf(scan, params.modalities)) {
        const ChannelSamples samples =
            filterChannels(scan, together, params.filter, params.modality);
        if (samples.size() == 0) continue;
        Names names;
        for (const Channel* channel : together) names.push_back(channel->name);
        // Of names that were seen before and others, and of names of different groups, each
        // goes on by itself.
        for (const Names& part : parts(names)) {
            std::vector<int> channels;
            for (const std::string& name : part)
                channels.push_back(static_cast<int>(
                    std::find(names.begin(), names.end(), name) - names.begin()));
            isolate(part).insert(
                part.size() == names.size() ? samples : samples.withChannels(channels),
                T_local_sensor, params);
        }
    }
    relink();
}

std::vector<std::vector<std::string>> Modalities::parts(const Names& names) const {
    std::vector<Names> result;
    Names unseen = names;
    for (const ModalityGroup& group : groups_) {
        const Names both = intersection(group.names(), names);
        if (!both.empty()) result.push_back(both);
        unseen = difference(unseen, group.names());
    }
    if (!unseen.empty()) result.push_back(unseen);
    return result;
}

ModalityGroup& Modalities::isolate(const Names& names) {
    for (std::size_t g = 0; g < groups_.size(); ++g) {
        if (groups_[g].names() == names) return groups_[g];
        if (!contains(groups_[g].names(), names.front())) continue;
        groups_.push_back(groups_[g].withNames(names));
        groups_[g] = groups_[g].withNames(difference(groups_[g].names(), names));
        return groups_.back();
    }
    groups_.emplace_back(names, ChannelMixture(static_cast<int>(names.size())));
    return groups_.back();
}

void Modalities::merge(const Modalities& other, const Pose& T_local_other,
                       const MapParams& params) {
    for (const ModalityGroup& theirs : other.groups_)
        for (const Names& part : parts(intersection(theirs.names(), params.modalities)))
            isolate(part).merge(theirs.withNames(part), T_local_other, params);
    relink();
}

void Modalities::configure(const MapParams& params) {
    std::vector<ModalityGroup> kept;
    for (const ModalityGroup& group : groups_) {
        const Names names = intersection(group.names(), params.modalities);
        if (!names.empty()) kept.push_back(group.withNames(names));
    }
    groups_ = std::move(kept);
    hierarchy_ = params.hierarchy;
    relink();
}

const ModalityMap* Modalities::find(const std::string& name) const {
    for (const ModalityMap& map : maps_)
        if (map.name() == name) return &map;
    return nullptr;
}

void Modalities::add(ModalityGroup group) {
    groups_.push_back(std::move(group));
    relink();
}

void Modalities::relink() {
    maps_.clear();
    for (const ModalityGroup& group : groups_)
        for (std::size_t c = 0; c < group.names().size(); ++c)
            maps_.emplace_back(group, static_cast<int>(c), hierarchy_);
}

std::size_t Modalities::liveBytes() const {
    std::size_t bytes = maps_.capacity() * sizeof(ModalityMap);
    for (const ModalityGroup& group : groups_) bytes += group.liveBytes();
    return bytes;
}

}  // namespace hgmm
