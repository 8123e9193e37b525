/* Opens an extension's library as the engine does on a system: open_extension_posix.c, open_extension_windows.c. */
/** The function `name` of the library at `path`, which finds what it needs in its own folder; NULL and a line on stderr where
 * not. */
void (*open_extension(const char* path, const char* name))(void);
