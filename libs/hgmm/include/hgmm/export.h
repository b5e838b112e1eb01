#pragma once

/// Marks what programs outside of the library may link. Everything else is hidden.
#define HGMM_EXPORT __attribute__((visibility("default")))
