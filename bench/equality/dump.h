#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace equality {

/// What a section holds.
enum class Kind : std::uint8_t { components, answers };

/// Type of a section's numbers.
enum class Number : std::uint8_t { byte, count, single, real };

/// One table of a dump. All its numbers are of one type, row by row.
struct Section {
    std::string name;  ///< "surfaces, level 0"
    Kind kind = Kind::answers;
    std::string row;                   ///< what a row is: "component", "point"
    std::vector<std::string> columns;  ///< at least one
    Number number = Number::real;
    std::vector<std::uint8_t> bytes;

    std::size_t numbers() const;  ///< [count]
    std::size_t rows() const { return numbers() / columns.size(); }
};

/// Bytes of one number.
std::size_t sizeOf(Number number);

template <typename T>
constexpr Number numberOf() {
    if constexpr (std::is_same_v<T, float>) {
        return Number::single;
    } else if constexpr (std::is_same_v<T, double>) {
        return Number::real;
    } else if constexpr (std::is_same_v<T, std::uint64_t>) {
        return Number::count;
    } else {
        static_assert(std::is_same_v<T, std::uint8_t>);
        return Number::byte;
    }
}

/// All that a map of a recording says, as sections in the order of asking.
class Dump {
 public:
    /// Adds a table. Throws std::logic_error if the values do not fill whole rows or the
    /// name is taken.
    template <typename T>
    void add(const std::string& name, Kind kind, const std::string& row,
             const std::vector<std::string>& columns, const std::vector<T>& values) {
        const auto* first = reinterpret_cast<const std::uint8_t*>(values.data());
        add({name,
             kind,
             row,
             columns,
             numberOf<T>(),
             {first, first + values.size() * sizeof(T)}});
    }
    void add(Section section);

    const std::vector<Section>& sections() const { return sections_; }
    /// The section of a name; null if there is none.
    const Section* find(const std::string& name) const;
    Section* find(const std::string& name);

    /// Throw std::runtime_error naming the file.
    void write(const std::string& file) const;
    static Dump read(const std::string& file);

 private:
    std::vector<Section> sections_;
};

}  // namespace equality
