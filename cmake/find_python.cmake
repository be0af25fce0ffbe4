# treacle_find_python(VARIABLE MODULES): a python3 that can import these modules, "numpy" or "jsonschema, tomllib"; the
# system's own where the first one in PATH cannot. VARIABLE is false where there is none.
function(treacle_find_python VARIABLE MODULES)
  set(TREACLE_PYTHON_MODULES ${MODULES})
  find_program(${VARIABLE} python3 PATHS /usr/bin VALIDATOR treacle_imports_modules)
endfunction()
function(treacle_imports_modules OK PYTHON)
  execute_process(COMMAND ${PYTHON} -c "import ${TREACLE_PYTHON_MODULES}" RESULT_VARIABLE failed OUTPUT_QUIET ERROR_QUIET)
  if(failed)
    set(${OK} FALSE PARENT_SCOPE)
  endif()
endfunction()
