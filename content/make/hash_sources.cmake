# Writes the function limn::generators_hash(): a hash of the sources that generate meshes and images.
set(hashes "")
foreach(file ${FILES})
    file(SHA256 ${file} hash)
    string(APPEND hashes ${hash})
endforeach()
string(SHA256 hash "${hashes}")
file(
    WRITE ${OUTPUT}
    "#include \"content/load/files/asset_cache.h\"\n\n"
    "std::string_view limn::generators_hash() {\n    return \"${hash}\";\n}\n")
