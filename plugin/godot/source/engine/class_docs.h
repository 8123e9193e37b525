/* Texts of the class documentation, for the editor's help. */
#ifndef WADI_GODOT_CLASS_DOCS_H
#define WADI_GODOT_CLASS_DOCS_H

#include <stddef.h>

typedef struct ClassDoc {
    const char* xml; /* `size` bytes, without a final zero */
    size_t size;
} ClassDoc;
/** Ends with an entry of zeroes. class_docs.c is written by generate.py from doc_classes. */
extern const ClassDoc class_docs[];

#endif
