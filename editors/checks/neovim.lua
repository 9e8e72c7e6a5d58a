-- Opens an example: colours and folds of the parser, and a hover of the server. `editors/try` runs it.
local function check()
  vim.cmd("edit /opt/hyde/examples/first/first.hyde")
  assert(vim.treesitter.highlighter.active[vim.api.nvim_get_current_buf()], "no colours")
  local function capture(line, column)
    local found = vim.treesitter.get_captures_at_pos(0, line - 1, column - 1)
    return found[#found] and found[#found].capture
  end
  assert(capture(7, 1) == "keyword.type", "model")
  assert(capture(10, 28) == "string.special", "unit")
  local levels = { vim.fn.foldlevel(7), vim.fn.foldlevel(16), vim.fn.foldlevel(19), vim.fn.foldlevel(21) }
  assert(vim.deep_equal(levels, { 1, 2, 0, 1 }), vim.inspect(levels))

  vim.wait(20000, function() return #vim.lsp.get_clients({ bufnr = 0 }) > 0 end, 20)
  vim.api.nvim_win_set_cursor(0, { 13, 9 })
  local found = vim.lsp.buf_request_sync(0, "textDocument/hover", vim.lsp.util.make_position_params(), 20000)
  local hover = vim.inspect(found)
  assert(hover:find("a body that slides", 1, true), hover)
end

local passed, message = pcall(check)
local version = vim.version()
io.stdout:write(("Neovim %d.%d.%d: %s\n"):format(version.major, version.minor, version.patch, passed and "works" or message))
vim.cmd(passed and "qa!" or "cq!")
