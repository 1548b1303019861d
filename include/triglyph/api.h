// Marks what the shared library exports; everything else in it is hidden.
#pragma once

#if defined(__GNUC__)
#define TRIGLYPH_API __attribute__((visibility("default")))
#else
#define TRIGLYPH_API
#endif
