# glslang names the intermediate module as the target of its dependency file; Ninja wants the final one.
file(READ ${DEPFILE} text)
string(REGEX REPLACE "^[^:]*:" "${OUTPUT}:" text "${text}")
file(WRITE ${DEPFILE} "${text}")
