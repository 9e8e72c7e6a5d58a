vim.filetype.add({ extension = { hyde = "hyde" } })
vim.api.nvim_create_autocmd("FileType", {
  pattern = "hyde",
  callback = function(args)
    vim.bo[args.buf].commentstring = "// %s"
    -- Colours and folds of the parser, if parser/hyde.so and queries/hyde are in the runtime path.
    if pcall(vim.treesitter.start, args.buf, "hyde") then
      vim.wo.foldmethod = "expr"
      vim.wo.foldexpr = "v:lua.vim.treesitter.foldexpr()"
      vim.wo.foldlevel = 99
    end
    vim.lsp.start({
      name = "hyde",
      cmd = { "hyde", "lsp" },
      root_dir = vim.fs.dirname(
        vim.fs.find({ "hyde.toml", ".git" }, { upward = true, path = args.file })[1] or args.file
      ),
    })
  end,
})
