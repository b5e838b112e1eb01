#include "dump.h"

#include <fstream>
#include <stdexcept>
#include <utility>

namespace equality {
namespace {

constexpr char kMagic[] = "hgmm answers 1\n";

void put(std::ostream& out, std::uint64_t value) {
    out.write(reinterpret_cast<const char*>(&value), sizeof value);
}

void put(std::ostream& out, const std::string& text) {
    put(out, text.size());
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
}

std::uint64_t takeCount(std::istream& in) {
    std::uint64_t value = 0;
    in.read(reinterpret_cast<char*>(&value), sizeof value);
    return value;
}

std::string takeText(std::istream& in) {
    std::string text(takeCount(in), '\0');
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    return text;
}

Section takeSection(std::istream& in) {
    Section section;
    section.name = takeText(in);
    section.kind = static_cast<Kind>(takeCount(in));
    section.row = takeText(in);
    section.columns.resize(takeCount(in));
    for (std::string& column : section.columns) column = takeText(in);
    section.number = static_cast<Number>(takeCount(in));
    const std::string bytes = takeText(in);
    section.bytes.assign(bytes.begin(), bytes.end());
    return section;
}

}  // namespace

std::size_t sizeOf(Number number) {
    switch (number) {
        case Number::byte:
            return 1;
        case Number::single:
            return sizeof(float);
        case Number::count:
        case Number::real:
            return sizeof(double);
    }
    throw std::logic_error("a number of no known type");
}

std::size_t Section::numbers() const {
    return bytes.size() / sizeOf(number);
}

void Dump::add(Section section) {
    if (section.numbers() % section.columns.size() != 0)
        throw std::logic_error(section.name + ": a row is not whole");
    if (find(section.name)) throw std::logic_error(section.name + ": there are two");
    sections_.push_back(std::move(section));
}

const Section* Dump::find(const std::string& name) const {
    for (const Section& section : sections_)
        if (section.name == name) return &section;
    return nullptr;
}

Section* Dump::find(const std::string& name) {
    return const_cast<Section*>(std::as_const(*this).find(name));
}

void Dump::write(const std::string& file) const {
    std::ofstream out(file, std::ios::binary);
    out << kMagic;
    put(out, sections_.size());
    for (const Section& section : sections_) {
        put(out, section.name);
        put(out, static_cast<std::uint64_t>(section.kind));
        put(out, section.row);
        put(out, section.columns.size());
        for (const std::string& column : section.columns) put(out, column);
        put(out, static_cast<std::uint64_t>(section.number));
        put(out, std::string(section.bytes.begin(), section.bytes.end()));
    }
    out.close();
    if (!out) throw std::runtime_error(file + ": cannot be written");
}

Dump Dump::read(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    std::string magic(sizeof kMagic - 1, '\0');
    in.read(magic.data(), static_cast<std::streamsize>(magic.size()));
    if (!in || magic != kMagic) throw std::runtime_error(file + ": is no dump of answers");
    in.exceptions(std::ios::failbit | std::ios::badbit);
    Dump dump;
    for (std::uint64_t left = takeCount(in); left > 0; --left) dump.add(takeSection(in));
    return dump;
}

}  // namespace equality
