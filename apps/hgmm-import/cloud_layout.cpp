#include "cloud_layout.h"

#include <algorithm>
#include <cctype>

namespace hgmm::importer {
namespace {

bool sameLetter(char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) ==
           std::tolower(static_cast<unsigned char>(b));
}

}  // namespace

void CloudLayout::add(CloudField field) {
    field.column = columns;
    field.offset = stride;
    columns += field.count;
    stride += field.count * field.size;
    fields.push_back(std::move(field));
}

const CloudField* CloudLayout::find(const std::string& name) const {
    for (const auto& field : fields)
        if (field.name.size() == name.size() &&
            std::equal(name.begin(), name.end(), field.name.begin(), sameLetter))
            return &field;
    return nullptr;
}

}  // namespace hgmm::importer
