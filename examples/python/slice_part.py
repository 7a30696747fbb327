import lamella

stack = lamella.slice("part.stl", layer_height=0.1)
print(f"{len(stack)} layers, {stack.volume:.1f} mm3")
lamella.write("part.cli", stack)
